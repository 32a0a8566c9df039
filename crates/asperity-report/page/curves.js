// The charts of the page: what the rows follow, the solver, the material, the stress, the leak.

const chosen = { field: null, instant: 0, along: "x", share: 0.5 };

/** A series whose infinite numbers, null in JSON, are gaps. */
const numbers = (key) => state.series[key].map((value) => value ?? NaN);
const plain = (unit) => (unit === "1" ? "" : unit);

/** Charts of one part of the page, made once and given new numbers later. */
class Panels {
  constructor(id, options) {
    this.id = id;
    this.options = options;
    this.charts = [];
  }

  set(specs) {
    specs.forEach((spec, k) => (this.charts[k] ? this.charts[k].set(spec) : this.charts.push(new Chart($(this.id), spec, this.options))));
  }
}

// Charts over the rows have one cursor and one zoom; a click shows the maps of that time.
const overRows = { shared: "rows", pick: (at) => showNearest(at) };
const forces = new Panels("evolution", {});
const evolution = new Panels("evolution", overRows);
const loading = new Panels("evolution", {});
const cyclesOf = new Panels("evolution", { shared: "cycle number" });
const solver = new Panels("solver", { shared: "row number" });
const leaks = new Panels("leaks", overRows);
const stresses = new Panels("stress-curves", overRows);
const materials = new Panels("curves", {});
const spectra = new Panels("spectrum", {});

/** Words in place of curves that are zero at all times. */
const ZERO = { contact_area: "Nothing touches at any time.", mean_pressure: "No pressure: nothing touches at any time.",
  contact_spots: "No contact spots: nothing touches at any time.", largest_spot: "No contact spots: nothing touches at any time." };

const rowsAxis = () => ({ label: state.rows.label, unit: state.rows.unit, log: state.rows.log });

/** Where the stages of the load begin, with their number. */
function stages() {
  const stage = state.series.stage ?? [];
  return stage.flatMap((now, n) => (n > 0 && now !== stage[n - 1] ? [{ at: state.series.time[n], text: `stage ${now + 1}` }] : []));
}

/** Load over approach of surfaces that adhere: both branches, and the pull-off. */
function forceCurve({ approaching, parting, pull_off }) {
  const x = numbers("approach"), gaps = (values) => values.map((value) => value ?? NaN);
  return { title: "Load over approach", free: true, x: { label: "approach", unit: "m" }, y: { label: "load", unit: state.units.load },
    events: [{ at: x[pull_off], text: "pull-off" }],
    series: [{ name: "approaching", x, y: gaps(approaching) }, { name: "parting", x, y: gaps(parting) }] };
}

/** The curves whose displacement is more than the rounding errors of the other one. */
function moving(curves) {
  const far = ({ x }) => Math.max(...x.map(Math.abs)), most = Math.max(...curves.map(far));
  return curves.filter((curve) => far(curve) > 1e-6 * most);
}

/** Tangential force over tangential displacement, of each component that moves: with friction a loop. */
function tangentialLoop() {
  const of = (axis) => ({ name: `along ${axis}`, x: numbers(`tangential_displacement_${axis}`), y: numbers(`tangential_force_${axis}`) });
  return { title: "Tangential force over displacement", free: true, x: { label: "tangential displacement", unit: "m" },
    y: { label: "tangential force", unit: state.units.tangential_force_x },
    series: moving(["x", "y"].map(of)) };
}

function evolutionPart() {
  const time = state.series.time, events = stages();
  const adheres = Boolean(state.force_curve);
  if (adheres) forces.set([forceCurve(state.force_curve)]);
  if (state.slips) forces.set([tangentialLoop()]);
  evolution.set(state.evolution.map(([title, label, names, states]) => ({
    title,
    x: rowsAxis(),
    y: { label, unit: plain(state.units[names[0][1]]), states: states?.length ? states : null, linear: Boolean(states?.length) || label === "temperature" },
    zero: ZERO[names[0][1]],
    none: names[0][1] in ZERO ? ZERO[names[0][1]] : undefined,
    events,
    series: names.map(([name, key]) => ({ name, x: time, y: numbers(key), dashed: key.startsWith("persson") })),
  })));
  const over = (title, from, to) => ({
    title, free: true, x: { label: "approach", unit: "m" }, y: { label: "load", unit: state.units.load },
    zero: "The load is zero at all times.",
    series: [{ name: "", x: numbers("approach").slice(from, to), y: numbers("load").slice(from, to) }],
  });
  const cycle = state.last_cycle;
  // A constant load or approach makes a straight line along an axis, which shows nothing.
  const varies = (key) => {
    const values = numbers(key).filter(isFinite), low = Math.min(...values), high = Math.max(...values);
    return high - low > 1e-6 * Math.max(Math.abs(low), Math.abs(high));
  };
  const whole = !adheres && varies("load") && varies("approach") ? [over("Load over approach")] : [];
  loading.set([...whole, ...(cycle ? [over("Load over approach, last cycle", cycle[0], cycle[1] + 1)] : [])]);
  $("last-cycle").hidden = !cycle;
  cyclesOf.set(state.cycles.filter((part) => part.loss_angle.length > 1).flatMap(cyclePanels));
}

/** What each cycle of a sine loses, over its number. */
function cyclePanels(part) {
  const panel = (title, label, unit, values) => ({
    title: `${title}, cycles at ${words(part.frequency, "Hz")}`,
    x: { label: "cycle", unit: "", linear: true }, y: { label, unit },
    series: [{ name: "", x: values.map((_, n) => n + 1), y: values.map((value) => value ?? NaN) }],
  });
  const line = state.grid.line ? "/m" : "";
  return [panel("Loss angle", "loss angle", "°", part.loss_angle), panel("Work over a cycle", "work", `J${line}`, part.dissipated_energy),
    panel("Dynamic stiffness", "stiffness", `N/m${line ? "2" : ""}`, part.stiffness)];
}

function solverPart() {
  const row = { label: "row", unit: "", linear: true };
  const points = (name, key) => ({ name, x: state.series.time.map((_, n) => n), y: numbers(key), points: true });
  solver.set(state.solver.map(([title, label, names]) => ({
    title, x: row, y: { label, unit: "", log: label === "relative error" },
    zero: label === "relative error" ? "The error is zero in all rows." : undefined,
    series: names.map(([name, key]) => points(name, key)),
  })));
}

function materialPart() {
  const m = state.material;
  $("material").hidden = !m;
  if (!m) return;
  $("material-words").textContent = m.reduced ? "At the reference temperature of the shift; at another temperature, times are longer by its factor a_T." : "";
  const time = { label: "time", unit: "s", log: true }, frequency = { label: "frequency", unit: "Hz", log: true };
  materials.set([
    { title: "Contact creep compliance C(t)", x: time, y: { label: "compliance", unit: "1/Pa" }, series: [{ name: "", x: m.time, y: m.creep }] },
    ...(m.relaxation ? [{ title: "Contact relaxation modulus E*(t)", x: time, y: { label: "modulus", unit: "Pa", log: m.decades > 1 }, series: [{ name: "", x: m.time, y: m.relaxation }] }] : []),
    { title: "Storage and loss modulus", x: frequency, y: { label: "modulus", unit: "Pa", log: true }, series: [{ name: "storage", x: m.frequency, y: m.storage }, { name: "loss", x: m.frequency, y: m.loss, dashed: true }] },
    { title: "Loss tangent", x: frequency, y: { label: "tan δ", unit: "" }, zero: "tan δ is zero at all frequencies: nothing is lost.", series: [{ name: "", x: m.frequency, y: m.tangent }] },
  ]);
}

/** The stress below the surface: its picture is drawn once, as it is complete when it appears. */
function stressPart() {
  const s = state.stress;
  $("stress").hidden = !s;
  if (!s || $("stress-facts").children.length) return;
  $("stress-facts").replaceChildren(...terms(s.facts));
  const lines = [["von Mises", "mises"], ["shear (Tresca)", "tresca"], ["largest principal", "tension"]];
  if (s.time.length > 1) {
    stresses.set([{ title: "Largest stress below the surface", x: rowsAxis(), y: { label: "stress", unit: "Pa" }, zero: "No stress: nothing touches at any time.",
      series: lines.map(([name, key]) => ({ name, x: s.time, y: s[key].map((value) => value ?? NaN) })) }]);
  }
  $("stress-figure").hidden = !s.svg && !state.live;
  if (s.svg) $("stress-picture").src = "data:image/svg+xml;base64," + s.svg;
  else if (state.live) $("stress-picture").src = "stress.svg";
}

/** Where the seal closes and opens: events, and a sentence of the first time that it closes. Where `open` is null it is not known. */
function sealing(time, open) {
  const events = open.flatMap((now, n) => (n > 0 && now !== null && open[n - 1] !== null && !now !== !open[n - 1] ? [{ after: time[n - 1], at: time[n], text: now ? (open.slice(0, n).some(Boolean) ? "leaks again" : "leaks") : "tight" }] : []));
  const closed = events.find((event) => event.text === "tight");
  const unit = state.rows.unit;
  const note = closed ? `Closes between ${state.rows.symbol} = ${words(closed.after, unit)} and ${words(closed.at, unit)}: then no open path leads from inlet to outlet. A logarithmic axis cannot show zero.` : "";
  return [events, note];
}

/** A figure that stands in the page, or that a server draws. */
function drawing(name, svg, alt) {
  const place = $(`${name}-map`);
  if (svg) place.innerHTML = svg;
  else if (state.live && !place.children.length) place.append(make("img", { src: `${name}.svg`, alt }));
}

function leakPart() {
  const leak = state.leak;
  $("leakage").hidden = !leak;
  if (!leak) return;
  const x = leak.leak_time.values, open = leak.percolates.values.map((now, n) => (leak.holds[n] ? now : null)), [events, note] = sealing(x, open);
  const values = (key, factor = 1) => leak[key].values.map((value, n) => (value === null || !leak.holds[n] ? NaN : factor * value));
  const line = (name, key, dashed, factor) => ({ name, x, y: values(key, factor), dashed });
  const none = leak.taken ? `${leak.taken}.` : `The seal is tight at all ${state.rows.label === "time" ? "times" : "velocities"}: no open path from inlet to outlet.`;
  const specs = [
    { title: "Gaps", none, zero: none, events, x: rowsAxis(), y: { label: "gap", unit: "m", log: true }, series: [line("hydraulic: even gap, same leak", "hydraulic_gap"), line("critical: narrowest on best path", "critical_gap", true)] },
    { title: "Open cells", events, x: rowsAxis(), y: { label: "share of the domain", unit: "" }, zero: "No cell is open.", series: [{ name: "", x, y: leak.open_fraction.values }] },
  ];
  if (leak.leak_rate) {
    const gas = leak.leak_rate_standard;
    // kg/s of a gas to its rate at 0 °C: a factor that the gas alone decides.
    const ratios = gas ? gas.values.map((standard, n) => standard / leak.leak_rate.values[n]).filter(isFinite) : [];
    const factor = leak.shown.factor * (ratios.length ? ratios[0] : 1);
    const oneWay = leak.leak_rate_one_way, isTight = oneWay && !oneWay.values.some((rate) => rate > 0);
    const without = oneWay ? [line(`if the fluid did not act on the surfaces${isTight ? ": tight" : ""}`, "leak_rate_one_way", false, factor)] : [];
    specs.unshift({ title: "Leak rate", none, zero: none, events, x: rowsAxis(), y: { label: gas ? "leak rate, at 0 °C" : "leak rate", unit: leak.shown.text, log: true },
      series: [line("solved on the grid", "leak_rate", false, factor), ...without, line("estimate from the critical constriction", "leak_estimate_junction", true, factor),
        line("estimate from all gaps (effective medium)", "leak_estimate_medium", true, factor)] });
  }
  if (leak.opening_pressure) {
    const inlet = state.series.inlet_pressure;
    specs.push({ title: "Pressure of the inlet", events, x: rowsAxis(), y: { label: "pressure", unit: "Pa" },
      series: [line("that opens the contact suddenly", "opening_pressure"), ...(inlet ? [{ name: "of the run", x: state.series.time, y: numbers("inlet_pressure"), dashed: true }] : [])] });
  }
  // Once is enough.
  specs[0].note = note;
  leaks.set(specs);
  $("leak-asked").textContent = leak.asked;
  $("leak-words").textContent = leak.found;
  drawing("leak", state.leak_map, "Passages and flow");
  if (leak.acts) drawing("fluid", state.fluid_map, "Contact, pockets and pressure of the fluid");
  $("h-fluid").hidden = !$("fluid-map").children.length;
}

async function surfacePart() {
  const s = state.surface;
  $("surface").hidden = !s;
  if (!s) return;
  const map = await load("surface");
  if (map) {
    const [low, high] = robust(map), [least, most] = extent(map);
    heights.show({ map, colours: "sequential", low, high, unit: "m", label: "height" });
    $("height-note").textContent = `${s.note}${outside(least < low ? least : null, most > high ? most : null, "m")}`;
  }
  $("statistics").replaceChildren(...terms(s.statistics));
  if (s.wave_number) spectra.set([{ title: "Radially averaged power spectrum", x: { label: "wavenumber", unit: "1/m", log: true }, y: { label: "C(q)", unit: "m4", log: true }, series: [{ name: "", x: s.wave_number, y: s.power }] }]);
}

/** The switches of the axis that all charts over the rows share. */
function axisSwitches() {
  const buttons = [...document.querySelectorAll("[data-time]")];
  const group = () => [...evolution.charts, ...leaks.charts, ...stresses.charts];
  buttons.forEach((button) => {
    button.textContent = `${button.dataset.time === "log" ? "logarithmic" : "linear"} ${state.rows.label}`;
    button.addEventListener("click", () => {
      state.rows.log = button.dataset.time === "log";
      press(buttons, button);
      group().forEach((chart) => chart.use("x", state.rows.log));
      markInstant();
    });
  });
  press(buttons, buttons.find((button) => (button.dataset.time === "log") === state.rows.log));
  $("h-evolution").textContent = `Over ${state.rows.label}`;
  $("last-cycle").addEventListener("click", () => {
    const [from, to] = state.last_cycle.map((row) => state.series.time[row]);
    group().forEach((chart) => chart.window(from, to));
  });
}
