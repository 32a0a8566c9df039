// Maps over the area with their controls, the profile along a line, and the deformed surface.

const view = new MapView($("map"), $("bar"));
const heights = new MapView($("height"), $("height-bar"));
const relief = new Relief($("relief"), $("relief-bar"));
const profile = new Panels("profile", {});
const surfaces = new Panels("surfaces", {});

const field = () => state.fields.find((kind) => kind.name === chosen.field);
const has = (name) => state.fields.some((kind) => kind.name === name);
const moment = (instant) => `${state.rows.symbol} = ${words(instant.time, state.rows.unit)}`;

/** Colours of each field: {ends: "each" | "all" | "own", low, high, log}. */
const limits = {};
const limitsOf = (kind) => (limits[kind.name] ??= { ends: "each", log: false });

/** Ends of single maps, by name; those of the pressure of a run that is served come from its rows. */
const single = new Map();
/** So many values are fetched from a server to find the ends of all. */
const CELLS = 3e7;
const fromRows = (kind) => state.live && kind.colours === "pressure" && !limitsOf(kind).log;
const canShare = (kind) => !state.live || fromRows(kind) || state.instants.length * state.grid.cells.reduce((a, b) => a * b) <= CELLS;

/** The map of a stored time; `most` is its greatest value, also where the map holds means over blocks of cells. */
async function mapOf(kind, n) {
  const map = await load(`${kind.name}-${n}`);
  if (map && kind.name === "pressure") map.most = Math.max(map.max, state.series.max_pressure[state.instants[n].row] ?? 0);
  return map;
}

/** Ends that are common to all instants. */
async function commonEnds(kind, log) {
  if (fromRows(kind)) return [0, Math.max(...state.instants.map(({ row }) => state.series.max_pressure[row] ?? 0))];
  let low = Infinity, high = -Infinity;
  for (let n = 0; n < state.instants.length; n++) {
    const key = `${kind.name} ${log} ${n}`;
    if (!single.has(key)) {
      const map = await mapOf(kind, n);
      single.set(key, map && (map.max > 0 || !log) ? endsOf(map, kind, log, await contactOf(kind, n)) : [Infinity, -Infinity]);
    }
    const [a, b] = single.get(key);
    [low, high] = [Math.min(low, a), Math.max(high, b)];
  }
  if (low > high) return [0, 1];
  return [log ? Math.max(low, high * Math.pow(10, -DECADES)) : low, high];
}

/** The states of contact where they have a colour of their own in a map: in that of the gap, which is zero there but for rounding. */
const contactOf = async (kind, n) => (kind.name === "gap" && has("contact") ? load(`contact-${n}`) : null);

/** The map of an instant with its colours. */
async function coloured(kind, map, contact) {
  const chosenLimits = limitsOf(kind), { log } = chosenLimits;
  if (chosenLimits.ends === "all" && !canShare(kind)) chosenLimits.ends = "each";
  let [low, high] = chosenLimits.ends === "own" ? [chosenLimits.low, chosenLimits.high]
    : chosenLimits.ends === "all" ? await commonEnds(kind, log) : endsOf(map, kind, log, contact);
  if (low === high) high = low === 0 ? 1 : low + Math.abs(low);
  const swatches = kind.colours === "pressure" ? [[OPEN, "no contact"]] : contact ? [[TOUCHING, "contact"]] : [];
  if (map.holes) swatches.push([UNDEFINED, "undefined"]);
  const inside = extent(map, contact), [least, most] = inside ? [inside[0], map.most ?? inside[1]] : [low, high], states = kind.colours === "states";
  // Less than half of a colour beyond an end is rounding.
  const past = (value) => Math.max(-share(value, low, high, log), share(value, low, high, log) - 1) > 0.5 / 256;
  const beyond = [!states && kind.colours !== "pressure" && least < low && !(log && least <= 0) && past(least), !states && most > high && past(most)];
  const none = kind.colours === "pressure" && map.max <= 0 && chosenLimits.ends === "each";
  const note = none ? " Nothing touches." : inside ? outside(beyond[0] ? least : null, beyond[1] ? most : null, kind.unit) : " All cells that can touch do.";
  const overlap = contact && least < 0 ? " Negative: the surfaces overlap at the hardness, where the pressure is cut off; the overlap is plastic flattening." : "";
  return { map, contact, colours: kind.colours, low, high, log, unit: kind.unit, label: kind.label, swatches, beyond, note: note + overlap, closed: !inside || none };
}

async function showMap() {
  const kind = field();
  if (!kind || !state.instants.length) return;
  const instant = state.instants[chosen.instant], index = chosen.instant;
  const stale = () => kind !== field() || instant !== state.instants[chosen.instant];
  const map = await mapOf(kind, index);
  if (!map || stale()) return;
  const touches = kind.colours === "pressure" || kind.name === "contact" ? map.max > 0 : state.series.contact_area[instant.row] > 0;
  $("map-title").textContent = `${kind.title} at ${moment(instant)}${touches ? "" : ": no contact"}`;
  if (state.grid.line) await showOverTime(kind, instant, stale);
  else {
    const what = await coloured(kind, map, await contactOf(kind, index));
    if (stale()) return;
    what.note += MapView.stretched();
    view.show(what, { along: chosen.along, share: chosen.share });
    showLimits(kind, what);
  }
  const row = instant.row;
  $("instant-words").textContent = `${moment(instant)}, load ${words(state.series.load[row], state.units.load)}, contact ${digits(100 * state.series.contact_fraction[row])} %`;
  $("instant").setAttribute("aria-valuetext", moment(instant));
  $("instant").value = index;
  markInstant();
  await showProfile(kind, map);
  await (state.grid.line ? showSurfaces(instant) : showRelief(instant));
}

/** A dashed line in the charts over the rows, where the maps are. */
function markInstant() {
  $("mark-note").hidden = !state.instants.length;
  evolution.charts.forEach((chart) => chart.mark(state.instants[chosen.instant]?.time));
}

/** The stored instant nearest to a place along the axis of the rows. */
function showNearest(at) {
  if (!state.instants.length) return;
  const far = (n) => Math.abs(state.instants[n].time - at);
  chosen.instant = state.instants.reduce((best, _, n) => (far(n) < far(best) ? n : best), 0);
  showMap();
}

/** The ends of the colours as the controls tell them, and what lies beyond. */
function showLimits(kind, { low, high, log, note }) {
  $("limits-part").hidden = kind.colours === "states";
  if (kind.colours === "states") return ($("map-range").textContent = state.grid.line ? "" : MapView.stretched());
  const largest = Math.max(Math.abs(low), Math.abs(high)), shownUnit = shown(kind.unit, largest);
  $("limits").value = limitsOf(kind).ends;
  if (!state.grid.line) $("limits").querySelector("[value=all]").disabled = !canShare(kind);
  for (const [id, value] of [["low", low], ["high", high]]) {
    if (document.activeElement !== $(id)) $(id).value = rounded(value * shownUnit.factor, log ? value * shownUnit.factor : largest * shownUnit.factor);
    $(id).removeAttribute("aria-invalid");
  }
  $("limits-unit").textContent = shownUnit.text;
  $("limits-unit").dataset.factor = shownUnit.factor;
  $("log-colours").checked = log;
  $("map-range").textContent = note;
}

/** Limits that were typed: numbers in the unit shown. */
function typedLimits() {
  const kind = field(), factor = Number($("limits-unit").dataset.factor);
  const [low, high] = ["low", "high"].map((id) => Number($(id).value.replace(",", ".").replace("−", "-")) / factor);
  const good = isFinite(low) && isFinite(high) && low < high && !(limitsOf(kind).log && low <= 0) && $("low").value.trim() && $("high").value.trim();
  for (const id of ["low", "high"]) $(id).setAttribute("aria-invalid", String(!good));
  if (!good) return;
  Object.assign(limitsOf(kind), { ends: "own", low, high });
  showMap();
}

/** A line contact over x and time, at each time the nearest stored instant; the line is the instant shown. */
async function showOverTime(kind, instant, stale) {
  const times = state.instants.map((one) => one.time), last = times[times.length - 1];
  const log = state.rows.log && times.filter((time) => time > 0).length > 1;
  const first = log ? times.find((time) => time > 0) : times[0];
  // Velocities of a sweep are no times: states between them are not like their neighbours.
  const drawn = last > first && state.rows.label === "time";
  $("map").closest("figure").hidden = $("limits-part").hidden = !drawn;
  if (!drawn) return;
  const rows = 128;
  const values = { min: Infinity, max: -Infinity };
  let nearest = 0;
  for (let k = 0; k < rows; k++) {
    const part = (k + 0.5) / rows, time = log ? first * Math.pow(last / first, part) : first + part * (last - first);
    while (nearest + 1 < times.length && Math.abs(times[nearest + 1] - time) <= Math.abs(times[nearest] - time)) nearest += 1;
    const one = await load(`${kind.name}-${nearest}`);
    if (!one) return;
    if (!values.values) Object.assign(values, { nx: one.nx, ny: rows, values: new Float32Array(one.nx * rows) });
    for (let i = 0; i < one.nx; i++) values.values[i * rows + k] = one.values[i];
    [values.min, values.max] = [Math.min(values.min, one.min), Math.max(values.max, one.max)];
  }
  if (stale()) return;
  $("map-title").textContent = `${kind.title} over x and time; the line is ${moment(instant)}`;
  const what = await coloured(kind, values, null);
  what.rows = { unit: state.rows.unit, first, last, log };
  view.show(what, { along: "x", share: Math.min(Math.max(share(instant.time, first, last, log), 0), 1) });
  showLimits(kind, what);
}

/** The undeformed gap h0 at the chosen instant; of surfaces that move, wear or flatten where it is stored, else nothing. */
function undeformed() {
  if (has("undeformed_gap")) return load(`undeformed_gap-${chosen.instant}`);
  return state.still ? load("initial") : null;
}

/** Both surfaces in a line contact: z = -u and z = h0 - w, with u = h - h0 + w. */
async function showSurfaces(instant) {
  const name = has("gap") ? "gap" : has("displacement") ? "displacement" : null;
  $("relief-part").hidden = true;
  const map = name && (await load(`${name}-${chosen.instant}`)), before = await undeformed();
  if (!map || !before) return;
  const approach = state.series.approach[instant.row];
  const place = Array.from({ length: map.nx }, (_, k) => ((k + 0.5) / map.nx) * state.grid.size[0]);
  const other = Array.from(before.values, (h0) => h0 - approach);
  const deformed = Array.from(map.values, (v, n) => (name === "gap" ? other[n] - v : -v));
  const finite = deformed.filter((z) => isFinite(z));
  const low = finite.reduce((a, b) => Math.min(a, b), Infinity), high = finite.reduce((a, b) => Math.max(a, b), -Infinity);
  const seen = other.map((z) => (z <= high + (high - low) ? z : NaN));
  surfaces.set([{ title: `Surfaces in contact at ${moment(instant)}`, x: { label: "x", unit: "m", linear: true }, y: { label: "height", unit: "m", linear: true },
    series: [{ name: "deformed surface", x: place, y: deformed }, { name: "other surface", x: place, y: seen, dashed: true }] }]);
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
    const now = await undeformed(), start = now && state.still ? null : await load("initial");
    if (now) series.push({ name: "undeformed", x, y: along(now)[1], dashed: true });
    if (start) series.push({ name: "undeformed at the start", x, y: along(start)[1], dashed: true });
  }
  const time = moment(state.instants[chosen.instant]);
  const title = state.grid.line ? `${kind.title} at ${time}` : `${kind.title} at ${across} = ${words(where, "m")}, ${time}`;
  profile.set([{ title, x: { label: chosen.along, unit: "m", linear: true }, y: { label: kind.label, unit: plain(kind.unit) }, series,
    zero: kind.name === "pressure" ? "No pressure along this line." : undefined }]);
}

/** Surface of the deformed body: down by u, where u = h - h0 + w. */
async function showRelief(instant) {
  const name = has("displacement") ? "displacement" : has("gap") ? "gap" : null, index = chosen.instant;
  $("relief-part").hidden = !name;
  if (!name) return;
  const map = await load(`${name}-${index}`), before = name === "gap" ? await undeformed() : null;
  const pressure = has("pressure") ? await load(`pressure-${index}`) : null;
  if (!map || index !== chosen.instant) return;
  if (name === "gap" && !before) return ($("relief-part").hidden = true);
  const approach = state.series.approach[instant.row];
  const z = Float32Array.from(map.values, (v, n) => (before ? before.values[n] - v - approach : -v));
  const loaded = pressure && pressure.max > 0, finite = z.filter((v) => !isNaN(v));
  const [low, high] = [finite.reduce((a, b) => Math.min(a, b), Infinity), finite.reduce((a, b) => Math.max(a, b), -Infinity)];
  // Less than what two maps of 16 bits can tell is no deformation.
  const rounding = before ? (4 * (map.max - map.min + before.max - before.min)) / 65534 : 0;
  $("relief").parentElement.hidden = high - low <= rounding;
  $("relief-title").textContent = `Deformed surface at ${moment(instant)}`;
  if (high - low <= rounding) return ($("relief-note").textContent = "The surface is not deformed.");
  // Tension below zero, of surfaces that adhere.
  const most = pressure && Math.max(pressure.max, -pressure.min), { colours } = state.fields.find((kind) => kind.name === "pressure") ?? {};
  const what = loaded
    ? { colours, low: colours === "diverging" ? -most : 0, high: most, unit: "Pa", label: "pressure" }
    : { colours: "sequential", low, high, unit: "m", label: "height" };
  relief.show(map.nx, map.ny, z, loaded ? pressure.values : z, what);
  const stretched = `stretched ${digits(Number(relief.stretch().toPrecision(2)))} times against ${relief.sidesNote() ? "the longer side" : "x and y"}${relief.sidesNote()}`;
  $("relief-note").textContent = `Surface of the deformable body, heights from ${words(low, "m")} to ${words(high, "m")}, ${stretched}; coloured by ${loaded ? "pressure" : "height"}. Drag, or use the arrow keys, to turn it.`;
}
