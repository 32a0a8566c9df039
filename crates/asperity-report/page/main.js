// The page: what stands where, and what moves what.

const $ = (id) => document.getElementById(id);
const press = (buttons, chosen) => buttons.forEach((b) => b.setAttribute("aria-pressed", String(b === chosen)));

// Light and dark: as the system has it, until the button is used.
const dark = window.matchMedia("(prefers-color-scheme: dark)");
function theme(name) {
  document.documentElement.dataset.theme = name;
  charts.forEach((chart) => chart.render());
  if (view.what) view.render();
  if (heights.what) heights.render();
}

const view = new MapView($("map"), $("bar"));
const heights = new MapView($("height"), $("height-bar"));
const relief = new Relief($("relief"));
const chosen = { field: null, instant: 0, along: "x", share: 0.5, log: state.rows.log };
const evolution = [];
let profile = null;

document.documentElement.dataset.theme = dark.matches ? "dark" : "light";
dark.addEventListener("change", (event) => theme(event.matches ? "dark" : "light"));
$("theme").addEventListener("click", () => theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));

function summary() {
  $("title").textContent = state.title;
  document.title = state.title;
  $("status").textContent = state.status;
  $("case").textContent = state.case;
  $("footer").textContent = state.footer;
  $("findings").hidden = !state.findings.length;
  $("finding-list").replaceChildren(...state.findings.map((finding) =>
    make("li", { class: finding.severity }, make("b", {}, finding.severity), ` ${finding.text} `, make("code", {}, finding.code))));
  $("headline").replaceChildren(...state.headline.map(([name, value]) => make("div", {}, make("b", {}, value), make("span", {}, name))));
  $("facts").replaceChildren(...state.facts.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]));
}

/** The panels over time: their series by name. */
const PANELS = [
  state.grid.line
    ? ["Contact length", "contact length", [["", "contact_area"], ["at hardness", "capped_area"]]]
    : ["Contact area", "contact area", [["counted", "contact_area"], ["corrected", "contact_area_corrected"], ["at hardness", "capped_area"],
        ...(state.series.persson_contact_area ? [["Persson's theory", "persson_contact_area"]] : [])]],
  ["Approach", "approach", [["", "approach"]]],
  ["Load", "load", [["", "load"]]],
  ["Pressure", "pressure", [["nominal mean", "mean_pressure"], ["largest", "max_pressure"], ["mean over the contact", "contact_pressure"]]],
];

/** A series whose infinite numbers, null in JSON, are gaps. */
const numbers = (key) => state.series[key].map((value) => value ?? NaN);

function timePanels() {
  const time = state.series.time;
  const axis = { label: state.rows.label, unit: state.rows.unit, log: chosen.log };
  const specs = [...PANELS, ...state.quantities].map(([title, label, names]) => ({
    title,
    x: axis,
    y: { label, unit: state.units[names[0][1]] === "1" ? "" : state.units[names[0][1]] },
    series: names.filter(([, key]) => key !== "capped_area" || state.series[key].some((v) => v > 0)).map(([name, key]) => ({ name, x: time, y: numbers(key), dashed: key.startsWith("persson") })),
  }));
  if (!evolution.length) {
    specs.forEach((spec) => evolution.push(new Chart($("evolution"), spec)));
    loading = new Chart($("evolution"), loadingPath());
  } else {
    specs.forEach((spec, k) => evolution[k].set(spec));
    loading.set(loadingPath());
  }
}
let loading = null;
const loadingPath = () => ({
  title: "Load over approach",
  free: true,
  x: { label: "approach", unit: "m" },
  y: { label: "load", unit: state.units.load },
  series: [{ name: "", x: state.series.approach, y: state.series.load }],
});

const solver = [];
function solverPanels() {
  const row = state.series.time.map((_, n) => n);
  const points = (name, key) => ({ name, x: row, y: state.series[key], points: true });
  const specs = [{ title: "Work of each row", x: { label: "row", unit: "" }, y: { label: "number", unit: "" }, series: [points("iterations", "iterations"), points("convolutions", "convolutions")] },
    { title: "Error of each row", x: { label: "row", unit: "" }, y: { label: "relative error", unit: "", log: true }, series: [points("contact conditions (residual)", "residual"), points("pressure (certificate)", "certificate")] }];
  specs.forEach((spec, k) => (solver[k] ? solver[k].set(spec) : solver.push(new Chart($("solver"), spec))));
}

function materialPanels() {
  const m = state.material;
  $("material").hidden = !m;
  if (!m) return;
  const time = { label: "time", unit: "s", log: true };
  new Chart($("curves"), { title: "Contact creep compliance C(t)", x: time, y: { label: "compliance", unit: "1/Pa" }, series: [{ name: "", x: m.time, y: m.creep }] });
  if (m.relaxation) new Chart($("curves"), { title: "Contact relaxation modulus E*(t)", x: time, y: { label: "modulus", unit: "Pa", log: m.decades > 1 }, series: [{ name: "", x: m.time, y: m.relaxation }] });
  const frequency = { label: "frequency", unit: "Hz", log: true };
  new Chart($("curves"), { title: "Storage and loss modulus", x: frequency, y: { label: "modulus", unit: "Pa", log: true }, series: [{ name: "storage", x: m.frequency, y: m.storage }, { name: "loss", x: m.frequency, y: m.loss, dashed: true }] });
  new Chart($("curves"), { title: "Loss tangent", x: frequency, y: { label: "tan δ", unit: "" }, series: [{ name: "", x: m.frequency, y: m.tangent }] });
}

const leaks = [];
function leakPanels() {
  const leak = state.leak;
  $("leakage").hidden = !leak;
  if (!leak) return;
  // A tight seal has no place on a logarithmic axis.
  const values = (key) => leak[key].values.map((value) => (value > 0 ? value : NaN));
  const x = leak.leak_time.values;
  const time = { label: state.rows.label, unit: state.rows.unit, log: chosen.log };
  const line = (name, key, dashed = false) => ({ name, x, y: values(key), dashed });
  const specs = [
    { title: "Gaps", x: time, y: { label: "gap", unit: "m", log: true }, series: [line("hydraulic", "hydraulic_gap"), line("critical", "critical_gap")] },
    { title: "Open cells", x: time, y: { label: "share of the domain", unit: "" }, series: [{ name: "", x, y: leak.open_fraction.values }] },
  ];
  if (leak.leak_rate) {
    const gas = leak.leak_rate_standard;
    // kg/s of a gas to mbar l/s: a factor that the gas alone decides.
    const ratios = gas ? gas.values.map((standard, n) => 10 * standard / leak.leak_rate.values[n]).filter(isFinite) : [];
    const factor = ratios.length ? ratios[0] : 1;
    const rate = (name, key, dashed) => ({ name, x, y: values(key).map((value) => factor * value), dashed });
    specs.unshift({ title: "Leak rate", x: time, y: { label: "leak rate", unit: gas ? "mbar l/s" : "m3/s", log: true },
      series: [rate("computed", "leak_rate"), rate("one junction", "leak_estimate_junction", true), rate("effective medium", "leak_estimate_medium", true)] });
  }
  const open = leak.percolates.values;
  const sealed = open.findIndex((now, n) => n > 0 && !now && open[n - 1] > 0);
  for (const spec of specs) {
    const shown = spec.series.flatMap((series) => series.y).filter((value) => value > 0);
    if (sealed > 0 && spec.y.log) spec.series.push({ name: "tight from here", x: [x[sealed], x[sealed]], y: [Math.min(...shown), Math.max(...shown)], dashed: true });
  }
  // Logarithmic axes have no place for a seal that never leaks.
  const drawn = open.some((now) => now > 0) ? specs : specs.filter((spec) => !spec.y.log);
  drawn.forEach((spec, k) => (leaks[k] ? leaks[k].set(spec) : leaks.push(new Chart($("leaks"), spec))));
  $("leak-asked").textContent = leak.asked;
  $("leak-words").textContent = leak.found;
  if (state.leak_map) $("leak-map").innerHTML = state.leak_map;
  else if (state.live && !$("leak-map").children.length) $("leak-map").append(make("img", { src: "leak.svg", alt: "Passages and flow" }));
}

async function surfacePart() {
  const s = state.surface;
  $("surface").hidden = !s;
  if (!s) return;
  const map = await load("surface");
  if (map) heights.show({ map, colours: "sequential", low: map.min, high: map.max, unit: "m", label: "height" });
  $("height-note").textContent = s.note;
  $("statistics").replaceChildren(...s.statistics.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]));
  if (s.wave_number) new Chart($("spectrum"), { title: "Radially averaged power spectrum", x: { label: "wavenumber", unit: "1/m", log: true }, y: { label: "C(q)", unit: "m4", log: true }, series: [{ name: "", x: s.wave_number, y: s.power }] });
}

const field = () => state.fields.find((f) => f.name === chosen.field);

async function showMap() {
  const kind = field();
  if (!kind || !state.instants.length) return;
  const instant = state.instants[chosen.instant];
  const map = await load(`${kind.name}-${chosen.instant}`);
  if (!map || kind !== field() || instant !== state.instants[chosen.instant]) return;
  const range = $("fixed").checked && kind.range ? [...kind.range] : [map.min, map.max];
  if (kind.colours === "pressure") range[0] = 0;
  if (state.grid.line) await showOverTime(kind, instant);
  else view.show({ map, colours: kind.colours, low: range[0], high: range[1], unit: kind.unit, label: kind.label }, { along: chosen.along, share: chosen.share });
  const row = instant.row;
  const moment = `${state.rows.symbol} = ${words(instant.time, state.rows.unit)}`;
  $("instant-words").textContent = `${moment}, load ${words(state.series.load[row], state.units.load)}, contact ${digits(100 * state.series.contact_fraction[row])} %`;
  $("instant").setAttribute("aria-valuetext", moment);
  evolution.forEach((chart) => chart.mark(instant.time));
  await showProfile(kind, map);
  await (state.grid.line ? showSurfaces(instant) : showRelief(instant));
}

/** A line contact over x and time, at each time the nearest stored instant; the line is the instant shown. */
async function showOverTime(kind, instant) {
  const times = state.instants.map((one) => one.time), first = times[0], last = times[times.length - 1];
  // Velocities of a sweep are no times: states between them are not like their neighbours.
  const shown = last > first && state.rows.label === "time";
  $("map").closest("figure").hidden = !shown;
  if (!shown) return;
  const rows = 128;
  let nearest = 0, picture = null, low = Infinity, high = -Infinity;
  for (let k = 0; k < rows; k++) {
    const time = first + ((k + 0.5) / rows) * (last - first);
    while (nearest + 1 < times.length && Math.abs(times[nearest + 1] - time) <= Math.abs(times[nearest] - time)) nearest += 1;
    const one = await load(`${kind.name}-${nearest}`);
    if (!one) return;
    if (!picture) picture = { nx: one.nx, ny: rows, values: new Float32Array(one.nx * rows) };
    for (let i = 0; i < one.nx; i++) picture.values[i * rows + k] = one.values[i];
    [low, high] = [Math.min(low, one.min), Math.max(high, one.max)];
  }
  if (kind !== field() || instant !== state.instants[chosen.instant]) return;
  const ends = kind.range ?? [low, high];
  const share = (instant.time - first) / (last - first);
  view.show({ map: picture, colours: kind.colours, low: ends[0], high: ends[1], unit: kind.unit, label: kind.label }, { along: "x", share });
}

/** Both surfaces in a line contact: z = -u and z = h0 - w, with u = h - h0 + w. */
let surfaces = null;
async function showSurfaces(instant) {
  const has = (name) => state.fields.some((f) => f.name === name);
  const name = has("gap") ? "gap" : has("displacement") ? "displacement" : null;
  $("relief-part").hidden = true;
  const map = name && (await load(`${name}-${chosen.instant}`)), before = await load("initial");
  if (!map || !before) return;
  const approach = state.series.approach[instant.row];
  const place = Array.from({ length: map.nx }, (_, k) => ((k + 0.5) / map.nx) * state.grid.size[0]);
  const other = Array.from(before.values, (h0) => h0 - approach);
  const deformed = Array.from(map.values, (v, n) => (name === "gap" ? other[n] - v : -v));
  const finite = deformed.filter((z) => isFinite(z));
  const low = finite.reduce((a, b) => Math.min(a, b), Infinity), high = finite.reduce((a, b) => Math.max(a, b), -Infinity);
  const seen = other.map((z) => (z <= high + (high - low) ? z : NaN));
  const spec = { title: "Surfaces in contact", x: { label: "x", unit: "m" }, y: { label: "height", unit: "m" },
    series: [{ name: "deformed surface", x: place, y: deformed }, { name: "other surface", x: place, y: seen, dashed: true }] };
  if (surfaces) surfaces.set(spec);
  else surfaces = new Chart($("profile"), spec);
}

/** Values along the line. */
function along(map) {
  const count = chosen.along === "x" ? map.nx : map.ny, other = chosen.along === "x" ? map.ny : map.nx;
  const at = Math.min(Math.floor(chosen.share * other), other - 1);
  const length = state.grid.size[chosen.along === "x" ? 0 : 1]; // a line has x alone
  const place = Array.from({ length: count }, (_, k) => ((k + 0.5) / count) * length);
  const value = Array.from({ length: count }, (_, k) => map.values[chosen.along === "x" ? k * map.ny + at : at * map.ny + k]);
  return [place, value, at, other];
}

async function showProfile(kind, map) {
  const [x, y, at, other] = along(map);
  const across = chosen.along === "x" ? "y" : "x";
  const where = ((at + 0.5) / other) * state.grid.size[chosen.along === "x" ? 1 : 0];
  const series = [{ name: kind.name === "gap" ? "now" : "", x, y }];
  if (kind.name === "gap") {
    const before = await load("initial");
    if (before) {
      const [x0, y0] = along(before);
      series.push({ name: "undeformed", x: x0, y: y0, dashed: true });
    }
  }
  const title = state.grid.line ? kind.title : `${kind.title} at ${across} = ${words(where, "m")}`;
  const spec = { title, x: { label: chosen.along, unit: "m" }, y: { label: kind.label, unit: kind.unit === "1" ? "" : kind.unit }, series };
  if (profile) {
    profile.box.querySelector("h3").textContent = spec.title;
    profile.set(spec);
  } else profile = new Chart($("profile"), spec);
}

/** Surface of the deformed body: down by u, where u = h - h0 + w. */
async function showRelief(instant) {
  const has = (name) => state.fields.some((f) => f.name === name);
  const name = has("displacement") ? "displacement" : has("gap") ? "gap" : null;
  $("relief-part").hidden = !name;
  if (!name) return;
  const map = await load(`${name}-${chosen.instant}`), before = name === "gap" ? await load("initial") : null;
  const pressure = has("pressure") ? await load(`pressure-${chosen.instant}`) : null;
  if (!map || (name === "gap" && !before)) return;
  const approach = state.series.approach[instant.row];
  const z = Float32Array.from(map.values, (v, n) => (before ? before.values[n] - v - approach : -v));
  let low = Infinity, high = -Infinity;
  for (const v of z) if (!isNaN(v)) [low, high] = [Math.min(low, v), Math.max(high, v)];
  const shade = pressure && pressure.max > 0 ? Float32Array.from(pressure.values, (p) => p / pressure.max) : Float32Array.from(z, (v) => (high > low ? (v - low) / (high - low) : 0));
  relief.show({ nx: map.nx, ny: map.ny, z, shade, colours: pressure && pressure.max > 0 ? "pressure" : "sequential" });
  $("relief-note").textContent = `Surface of the deformable half-space, heights from ${words(low, "m")} to ${words(high, "m")}, stretched upwards; coloured by ${pressure && pressure.max > 0 ? "pressure" : "height"}. Drag, or use the arrow keys, to turn it.`;
}

function mapsPart() {
  $("maps").hidden = !state.fields.length || !state.instants.length;
  if ($("maps").hidden) return;
  const buttons = state.fields.map((kind) => {
    const button = make("button", { type: "button", "aria-pressed": "false" }, kind.name);
    button.addEventListener("click", () => {
      chosen.field = kind.name;
      press(buttons, button);
      showMap();
    });
    return button;
  });
  $("fields").replaceChildren(...buttons);
  chosen.field = state.fields[0].name;
  press(buttons, buttons[0]);
  $("map-note").textContent = state.note;
  $("fixed").parentElement.hidden = !state.fields.some((kind) => kind.range);
  $("instant").max = state.instants.length - 1;
  chosen.instant = state.instants.length - 1;
  $("instant").value = chosen.instant;
  $("instant").addEventListener("input", () => {
    chosen.instant = Number($("instant").value);
    showMap();
  });
  $("fixed").addEventListener("change", showMap);
  const lines = [...document.querySelectorAll("[data-line]")];
  if (state.grid.line) {
    lines[0].parentElement.hidden = true;
    $("h-maps").textContent = "Fields";
    $("probe").textContent = "Over x and time, at each time the nearest stored instant. Point at it for values; drag to choose the instant.";
  }
  lines.forEach((button) => button.addEventListener("click", () => {
    chosen.along = button.dataset.line;
    press(lines, button);
    showMap();
  }));
  let timer = null;
  const stop = () => {
    clearInterval(timer);
    timer = null;
    $("play").setAttribute("aria-pressed", "false");
    $("play").textContent = "▶ play";
  };
  $("play").addEventListener("click", () => {
    if (timer) return stop();
    if (chosen.instant === state.instants.length - 1) chosen.instant = -1;
    $("play").setAttribute("aria-pressed", "true");
    $("play").textContent = "❚❚ pause";
    timer = setInterval(() => {
      chosen.instant += 1;
      $("instant").value = chosen.instant;
      showMap();
      if (chosen.instant >= state.instants.length - 1) stop();
    }, 350);
  });
  const canvas = $("map");
  const move = (event) => {
    if (!view.what) return;
    const { map, unit, label, colours } = view.what, [i, j] = view.cell(event), [lx, ly] = state.grid.size;
    const value = map.values[i * map.ny + j];
    if (state.grid.line) return overTime(event, map, i, j, value, unit, label, colours);
    const text = colours === "states" ? (isNaN(value) ? "undefined" : STATES[Math.round(value)][0]) : words(value, unit);
    $("probe").textContent = `x = ${words(((i + 0.5) / map.nx) * lx, "m")}, y = ${words(((j + 0.5) / map.ny) * ly, "m")}: ${label} ${text}`;
    if (event.buttons || event.type === "pointerdown") {
      chosen.share = chosen.along === "x" ? (j + 0.5) / map.ny : (i + 0.5) / map.nx;
      redraw();
    }
  };
  function overTime(event, map, i, j, value, unit, label, colours) {
    const times = state.instants.map((one) => one.time);
    const time = times[0] + ((j + 0.5) / map.ny) * (times[times.length - 1] - times[0]);
    const text = colours === "states" ? STATES[Math.round(value)]?.[0] ?? "undefined" : words(value, unit);
    $("probe").textContent = `x = ${words(((i + 0.5) / map.nx) * state.grid.size[0], "m")}, t = ${words(time, "s")}: ${label} ${text}`;
    if (!event.buttons && event.type !== "pointerdown") return;
    const nearest = times.reduce((best, t, n) => (Math.abs(t - time) <= Math.abs(times[best] - time) ? n : best), 0);
    if (nearest === chosen.instant) return;
    chosen.instant = nearest;
    $("instant").value = nearest;
    showMap();
  }
  canvas.addEventListener("pointermove", move);
  canvas.addEventListener("pointerdown", (event) => { canvas.setPointerCapture(event.pointerId); move(event); });
  canvas.addEventListener("keydown", (event) => {
    if (state.grid.line) return;
    const step = chosen.along === "x" ? { ArrowUp: 1, ArrowDown: -1 }[event.key] : { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step || !view.what) return;
    event.preventDefault();
    const count = chosen.along === "x" ? view.what.map.ny : view.what.map.nx;
    chosen.share = Math.min(Math.max(chosen.share + step / count, 0.5 / count), 1 - 0.5 / count);
    redraw();
  });
  function redraw() {
    view.show(view.what, { along: chosen.along, share: chosen.share });
    showProfile(field(), view.what.map);
  }
  return showMap();
}

const axes = [...document.querySelectorAll("[data-time]")];
axes.forEach((button) => (button.textContent = `${button.dataset.time === "log" ? "logarithmic" : "linear"} ${state.rows.label}`));
$("h-evolution").textContent = `Over ${state.rows.label}`;
press(axes, axes.find((button) => (button.dataset.time === "log") === chosen.log));
axes.forEach((button) => button.addEventListener("click", () => {
  chosen.log = button.dataset.time === "log";
  press(axes, button);
  timePanels();
  leakPanels();
  if (state.instants.length) evolution.forEach((chart) => chart.mark(state.instants[chosen.instant].time));
}));

/** The stress below the surface: drawn once, as it is complete when it appears. */
const stressCharts = [];
function stressPart() {
  const s = state.stress;
  $("stress").hidden = !s;
  if (!s || $("stress-facts").children.length) return;
  $("stress-facts").replaceChildren(...s.facts.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]));
  const lines = (x) => [["von Mises", "mises"], ["shear (s1 - s3)/2", "tresca"], ["largest principal", "tension"]].map(([name, key]) => ({ name, x, y: s[key].map((v) => v ?? NaN) }));
  if (s.time.length > 1) stressCharts.push(new Chart($("stress-curves"), { title: "Largest stress over time", x: { label: "time", unit: "s" }, y: { label: "stress", unit: "Pa" }, series: lines(s.time) }));
  $("stress-figure").hidden = !s.svg && !state.live;
  if (s.svg) $("stress-picture").src = "data:image/svg+xml;base64," + s.svg;
  else if (state.live) $("stress-picture").src = "stress.svg";
}

async function start() {
  summary();
  stressPart();
  timePanels();
  solverPanels();
  leakPanels();
  materialPanels();
  if (typeof DecompressionStream === "undefined") {
    $("maps").replaceChildren(make("p", { class: "notice" }, "This browser is too old to unpack the maps (it lacks DecompressionStream); all others since 2023 can."));
    $("surface").hidden = true;
  } else {
    await surfacePart();
    await mapsPart();
  }
  document.documentElement.dataset.ready = "yes";
  if (state.running) setTimeout(follow, 2000);
}

/** A run that goes on: what is new every two seconds. */
async function follow() {
  let next;
  try {
    next = await (await fetch("state")).json();
  } catch {
    $("status").textContent = "no longer served: start asperity view again";
    return;
  }
  const atEnd = chosen.instant >= state.instants.length - 1;
  if (next.instants.length < state.instants.length) cache.clear();
  const hadMaps = state.instants.length > 0;
  for (const key of ["series", "status", "headline", "facts", "instants", "fields", "running", "stress", "leak"]) state[key] = next[key];
  summary();
  stressPart();
  timePanels();
  solverPanels();
  leakPanels();
  if (!hadMaps && state.instants.length) await mapsPart();
  else if (state.instants.length) {
    $("instant").max = state.instants.length - 1;
    if (atEnd) {
      chosen.instant = state.instants.length - 1;
      $("instant").value = chosen.instant;
      await showMap();
    }
  }
  if (state.running) setTimeout(follow, 2000);
}
start();
