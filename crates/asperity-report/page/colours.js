// Colours of values: between which ends, linear or logarithmic, and the bar that tells them.

const LUT = Object.fromEntries(Object.entries(state.colours).map(([name, text]) => [name, bytes(text)]));
const STATES = [["open", [240, 240, 238]], [state.slips ? "sticking" : "contact", [0, 114, 178]], ["at the hardness", [213, 94, 0]], ["slipping", [230, 159, 0]]];
const OPEN = [240, 240, 238], TOUCHING = [120, 120, 118], UNDEFINED = [200, 200, 200];
/** Decades of a logarithmic map at the most. */
const DECADES = 6;

/** Share of the finite values of a map that may lie outside of its colours at each end. */
const OUTLIERS = 1e-3;

/** Whether a gap is that of contact, zero but for rounding; at the hardness the surfaces may overlap, which is a negative gap. */
const isClosed = (map, contact, n) => Boolean(contact) && (contact.values[n] === 1 || contact.values[n] === 3 || (contact.values[n] === 2 && map.values[n] >= 0));

/** Finite values of a map in rising order, without those of contact where its states are given; of the largest maps a sample. */
function sorted(map, contact) {
  if (map.sorted) return map.sorted;
  const every = Math.max(1, Math.floor(map.values.length / 250000));
  map.sorted = map.values.filter((value, n) => n % every === 0 && isFinite(value) && !isClosed(map, contact, n)).sort();
  return map.sorted;
}

/** Ends of the colours: all values, or without the few that would leave the others one colour. */
function robust(map, contact) {
  const values = sorted(map, contact), last = values.length - 1, few = Math.ceil(OUTLIERS * last);
  if (last < 0) return [0, 1];
  const [least, most] = extent(map, contact);
  if (last < 1000) return [least, most];
  const [low, high] = [values[few], values[last - few]];
  return high > low && most - least > 1.5 * (high - low) ? [low, high] : [least, most];
}

/** Ends for logarithmic colours: of the values above zero. */
function robustLog(map, contact) {
  const values = sorted(map, contact).filter((value) => value > 0), most = values[values.length - 1];
  if (!values.length) return [0.1, 1];
  return [Math.max(values[Math.ceil(OUTLIERS * (values.length - 1))], most * Math.pow(10, -DECADES)), map.most ?? most];
}

/** The ends of one map of a field. */
function endsOf(map, kind, log, contact) {
  if (kind.colours === "states") return [0, STATES.length - 1];
  if (log) return robustLog(map, contact);
  if (kind.colours === "diverging") {
    const most = Math.max(...robust(map, contact).map(Math.abs));
    return [-most, most];
  }
  return kind.colours === "pressure" ? [0, fence(map)] : robust(map, contact);
}

/**
 * The greatest pressure that the colours show: the outer fence Q3 + 3 (Q3 - Q1) of the positive values where those beyond it take
 * more than a third of their range (the edge of a punch, a single asperity), else the greatest value. Tukey, Exploratory Data Analysis, 1977.
 */
function fence(map) {
  const values = sorted(map), first = values.findIndex((value) => value > 0), count = values.length - first;
  const most = map.most ?? map.max;
  if (first < 0 || count < 100) return most;
  const [low, high] = [1, 3].map((n) => values[first + Math.floor((n * count) / 4)]);
  return most > 1.5 * (high + 3 * (high - low)) ? high + 3 * (high - low) : most;
}

/** Least and greatest value of a map, without contact where its states are given; null where none is left. */
function extent(map, contact) {
  const values = contact ? sorted(map, contact) : null;
  return !values ? [map.min, map.max] : values.length ? [values[0], values[values.length - 1]] : null;
}

/** What lies beyond the colours, in words: the least and the greatest value, null where they do not. */
function outside(least, most, unit) {
  const parts = [least === null ? "" : `down to ${words(least, unit)}`, most === null ? "" : `up to ${words(most, unit)}`].filter(Boolean);
  return parts.length ? ` Values outside of the colours: ${parts.join(" and ")}.` : "";
}

/** Place of a value between the ends, 0 to 1 within. */
function share(value, low, high, log) {
  if (log) return value > 0 ? Math.log(value / low) / Math.log(high / low) : -Infinity;
  return high > low ? (value - low) / (high - low) : 0;
}

// Entries of a palette after its 256 colours.
const [NO_CONTACT, CONTACT, NOTHING, FIRST_STATE] = [256, 257, 258, 259];

/** Red, green, blue of all entries, one after another. */
function palette(colours) {
  return [...(LUT[colours] ?? new Uint8Array(768)), ...[OPEN, TOUCHING, UNDEFINED, ...STATES.map(([, fill]) => fill)].flat()];
}

/** The entry of a value in the palette of {colours, low, high, log}; where `touching`, the gap is that of contact. */
function entry({ colours, low, high, log }, value, touching) {
  if (isNaN(value)) return NOTHING;
  if (colours === "states") return FIRST_STATE + Math.min(Math.max(Math.round(value), 0), STATES.length - 1);
  if (touching) return CONTACT;
  if (colours === "pressure" && value <= 0) return NO_CONTACT;
  return Math.min(Math.max(Math.round(255 * share(value, low, high, log)), 0), 255);
}

/** A canvas as sharp as the screen; returns its context in CSS pixels and its size. */
function sharp(canvas, height) {
  const dots = window.devicePixelRatio || 1, width = canvas.clientWidth || 300;
  canvas.style.height = height + "px";
  canvas.width = Math.round(width * dots);
  canvas.height = Math.round(height * dots);
  const context = canvas.getContext("2d");
  context.setTransform(dots, 0, 0, dots, 0, 0);
  context.font = "12px system-ui, sans-serif";
  return [context, width];
}

/** A swatch with its name, which may take two lines. */
function swatch(context, y, fill, name) {
  context.fillStyle = `rgb(${fill})`;
  context.fillRect(0, y, 13, 13);
  context.strokeStyle = css("--soft");
  context.strokeRect(0.5, y + 0.5, 12, 12);
  context.fillStyle = css("--ink");
  const lines = context.measureText(name).width > 58 ? name.split(" ") : [name];
  lines.forEach((word, n) => context.fillText(word, 18, y + 11 + 13 * n));
  return y + 13 * lines.length + 6;
}

/** The bar of {colours, low, high, log, unit, label, swatches, beyond}. */
function colourBar(canvas, tall, what) {
  const { colours, low, high, log, unit, label, swatches = [], beyond = [false, false] } = what;
  const height = Math.max(tall, 120), [context] = sharp(canvas, height);
  context.clearRect(0, 0, canvas.width, canvas.height);
  if (colours === "states") return void STATES.slice(0, state.slips ? 4 : 3).reduce((y, [name, fill]) => swatch(context, y + 4, fill, name), 2);
  if (what.closed) return void swatches.reduce((y, [fill, name]) => swatch(context, y, fill, name), 4);
  const lut = LUT[colours], foot = swatches.reduce((sum, [, name]) => sum + (context.measureText(name).width > 58 ? 32 : 19), 0);
  const top = beyond[1] ? 34 : 24, bottom = height - 8 - foot - (beyond[0] ? 8 : 0);
  for (let y = top; y < bottom; y++) {
    const k = 3 * Math.round((255 * (bottom - 1 - y)) / (bottom - 1 - top));
    context.fillStyle = `rgb(${lut[k]},${lut[k + 1]},${lut[k + 2]})`;
    context.fillRect(0, y, 13, 1.5);
  }
  // Arrows at the ends where values lie beyond them.
  const arrow = (from, to, k) => {
    context.fillStyle = `rgb(${lut[k]},${lut[k + 1]},${lut[k + 2]})`;
    context.beginPath();
    [[0, from], [13, from], [6.5, to]].forEach(([x, y]) => context.lineTo(x, y));
    context.fill();
  };
  if (beyond[1]) arrow(top, top - 8, 3 * 255);
  if (beyond[0]) arrow(bottom, bottom + 8, 0);
  const shownUnit = shown(unit, Math.max(Math.abs(low), Math.abs(high)));
  context.fillStyle = css("--ink");
  context.fillText(shownUnit.text || label, 0, 13);
  for (const { value, text } of ticks(low * shownUnit.factor, high * shownUnit.factor, (bottom - top) / 40, log)) {
    const y = bottom - share(value / shownUnit.factor, low, high, log) * (bottom - top);
    context.fillRect(13, y - 0.5, 4, 1);
    context.fillText(text, 20, y + 4);
  }
  swatches.reduce((y, [fill, name]) => swatch(context, y, fill, name), height - foot + 4);
}
