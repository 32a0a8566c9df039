// Maps of fields: values in colours, scale bar, probe and line.

const state = JSON.parse(document.getElementById("state").textContent);
const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
const cache = new Map();

/** The map of a name: {nx, ny, min, max, values, holes}; NaN where undefined, which `holes` says. Values are kept as 16 bits between min and max. */
async function load(name) {
  if (cache.has(name)) return cache.get(name);
  let packed;
  const part = document.getElementById("blob-" + name);
  if (part) packed = bytes(part.textContent);
  else if (state.live) {
    // Nothing comes where the page is left meanwhile, or is no longer served.
    const content = await fetch("map/" + name).then((answer) => answer.arrayBuffer()).catch(() => null);
    if (!content) return null;
    packed = new Uint8Array(content);
  } else return null;
  const head = new DataView(packed.buffer, packed.byteOffset, 24);
  const [min, max, nx, ny] = [head.getFloat64(0, true), head.getFloat64(8, true), head.getUint32(16, true), head.getUint32(20, true)];
  const stream = new Blob([packed.subarray(24)]).stream().pipeThrough(new DecompressionStream("deflate"));
  // A browser also gives up unpacking where the page is left.
  const opened = new Response(stream).arrayBuffer();
  const unpacked = await (state.live ? opened.catch(() => null) : opened);
  if (!unpacked) return null;
  const planes = new Uint8Array(unpacked);
  const count = nx * ny, values = new Float32Array(count), step = (max - min) / 65534;
  let holes = false;
  for (let i = 0, n = 0; i < nx; i++) {
    let level = 0; // each number is the difference from its neighbour along y
    for (let j = 0; j < ny; j++, n++) {
      level = (level + (planes[n] << 8) + planes[count + n]) & 0xffff;
      values[n] = level === 0xffff ? NaN : min + level * step;
      holes ||= level === 0xffff;
    }
  }
  const map = { nx, ny, min, max, values, holes };
  if (cache.size > 48) cache.delete(cache.keys().next().value);
  cache.set(name, map);
  return map;
}

/** A picture of a map, one pixel to a cell: x to the right, y upwards. */
function picture(what) {
  const { map, contact } = what, canvas = document.createElement("canvas");
  canvas.width = map.nx;
  canvas.height = map.ny;
  const context = canvas.getContext("2d");
  const image = context.createImageData(map.nx, map.ny);
  const fills = palette(what.colours);
  for (let i = 0, n = 0; i < map.nx; i++) {
    for (let j = 0; j < map.ny; j++, n++) {
      const from = 3 * entry(what, map.values[n], isClosed(map, contact, n)), to = 4 * ((map.ny - 1 - j) * map.nx + i);
      for (let k = 0; k < 3; k++) image.data[to + k] = fills[from + k];
      image.data[to + 3] = 255;
    }
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

/**
 * One map with its bar: what = {map, contact, colours, low, high, log, unit, label, swatches, beyond, rows}, `contact` the states where they
 * have a colour of their own, `rows` the times {label, unit, first, last, log} of a map over x and time.
 */
class MapView {
  constructor(canvas, bar) {
    this.canvas = canvas;
    this.bar = bar;
    onWidth(canvas.parentElement, () => this.what && this.render());
  }

  show(what, line) {
    this.what = what;
    this.line = line;
    this.image = picture(what);
    this.render();
  }

  /** Another line over the same map. */
  move(line) {
    this.line = line;
    this.render();
  }

  /** Height over width of a map of the area, which is stretched where it would be too narrow to be seen. */
  static ratio() {
    const [lx, ly] = state.grid.size;
    return Math.min(Math.max(ly / lx, 0.12), 2.5);
  }

  /** Along which axis the map is stretched, and how many times, as a sentence; empty where it is not. */
  static stretched() {
    const [lx, ly] = state.grid.size, times = MapView.ratio() / (ly / lx);
    if (Math.abs(times - 1) < 1e-9) return "";
    return ` The map is stretched ${digits(Number(Math.max(times, 1 / times).toPrecision(2)))} times along ${times > 1 ? "y" : "x"}.`;
  }

  render() {
    const { map, rows } = this.what, lx = state.grid.size[0];
    // Over x and time the height is free.
    const ratio = rows ? 0.6 : MapView.ratio();
    const height = Math.round((this.canvas.clientWidth || 300) * ratio), [context, width] = sharp(this.canvas, height);
    context.imageSmoothingEnabled = map.nx > width;
    context.drawImage(this.image, 0, 0, width, height);
    if (rows) this.timeTicks(context, height, rows);
    this.scaleBar(context, width, height, lx);
    if (this.line) {
      const { along, share } = this.line;
      const at = along === "x" ? (1 - share) * height : share * width;
      for (const [colour, thick] of [["#000", 3], ["#fff", 1.4]]) {
        context.strokeStyle = colour;
        context.lineWidth = thick;
        context.beginPath();
        if (along === "x") { context.moveTo(0, at); context.lineTo(width, at); }
        else { context.moveTo(at, 0); context.lineTo(at, height); }
        context.stroke();
      }
    }
    colourBar(this.bar, height, this.what);
  }

  /** A text on a light ground. */
  plate(context, text, x, y) {
    context.fillStyle = "rgba(255,255,255,.82)";
    context.fillRect(x - 3, y - 12, context.measureText(text).width + 6, 16);
    context.fillStyle = "#111";
    context.textAlign = "left";
    context.fillText(text, x, y);
  }

  timeTicks(context, height, { unit, first, last, log }) {
    const shownUnit = shownOnAxis(unit, last, log);
    for (const { value, text } of ticks(first * shownUnit.factor, last * shownUnit.factor, height / 60, log)) {
      const y = height * (1 - share(value / shownUnit.factor, first, last, log));
      if (y > height - 42 || y < 14) continue;
      this.plate(context, `${text} ${shownUnit.text}`, 11, y + 4);
      context.fillRect(0, y - 1, 7, 2);
    }
  }

  scaleBar(context, width, height, length) {
    if (height < 60) return;
    const rough = 0.27 * length, tens = Math.pow(10, Math.floor(Math.log10(rough) + 1e-9));
    const round = [5, 2, 1].find((k) => k * tens <= rough * (1 + 1e-9)) * tens;
    const text = words(round, "m"), long = (width * round) / length;
    const wide = Math.max(long, context.measureText(text).width) + 12;
    context.fillStyle = "rgba(255,255,255,.82)";
    context.fillRect(8, height - 36, wide, 28);
    context.fillStyle = "#111";
    context.fillRect(8 + (wide - long) / 2, height - 15, long, 4);
    context.textAlign = "center";
    context.fillText(text, 8 + wide / 2, height - 20);
  }

  /** The cell under a pointer. */
  cell(event) {
    const box = this.canvas.getBoundingClientRect();
    const { nx, ny } = this.what.map;
    const i = Math.floor(((event.clientX - box.left) / box.width) * nx);
    const j = Math.floor((1 - (event.clientY - box.top) / box.height) * ny);
    return [Math.min(Math.max(i, 0), nx - 1), Math.min(Math.max(j, 0), ny - 1)];
  }
}
