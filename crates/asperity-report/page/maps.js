// Maps of fields: values in colours, colour bar, scale bar, probe and line.

const state = JSON.parse(document.getElementById("state").textContent);
const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
const LUT = Object.fromEntries(Object.entries(state.colours).map(([name, text]) => [name, bytes(text)]));
const cache = new Map();

/** The map of a name: {nx, ny, min, max, values}; NaN where undefined. Values are kept as 16 bits between min and max. */
async function load(name) {
  if (cache.has(name)) return cache.get(name);
  let packed;
  const part = document.getElementById("blob-" + name);
  if (part) packed = bytes(part.textContent);
  else if (state.live) packed = new Uint8Array(await (await fetch("map/" + name)).arrayBuffer());
  else return null;
  const head = new DataView(packed.buffer, packed.byteOffset, 24);
  const [min, max, nx, ny] = [head.getFloat64(0, true), head.getFloat64(8, true), head.getUint32(16, true), head.getUint32(20, true)];
  const stream = new Blob([packed.subarray(24)]).stream().pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const count = nx * ny, values = new Float32Array(count), step = (max - min) / 65534;
  for (let i = 0, n = 0; i < nx; i++) {
    let level = 0; // each number is the difference from its neighbour along y
    for (let j = 0; j < ny; j++, n++) {
      level = (level + (planes[n] << 8) + planes[count + n]) & 0xffff;
      values[n] = level === 0xffff ? NaN : min + level * step;
    }
  }
  const map = { nx, ny, min, max, values };
  if (cache.size > 48) cache.delete(cache.keys().next().value);
  cache.set(name, map);
  return map;
}

const STATES = [["open", [240, 240, 238]], ["contact", [0, 114, 178]], ["at hardness", [213, 94, 0]]];

/** A picture of a map, one pixel to a cell: x to the right, y upwards. */
function picture(map, colours, low, high) {
  const canvas = document.createElement("canvas");
  canvas.width = map.nx;
  canvas.height = map.ny;
  const context = canvas.getContext("2d");
  const image = context.createImageData(map.nx, map.ny);
  const lut = LUT[colours], scale = high > low ? 255 / (high - low) : 0;
  for (let i = 0; i < map.nx; i++) {
    for (let j = 0; j < map.ny; j++) {
      const value = map.values[i * map.ny + j];
      const to = 4 * ((map.ny - 1 - j) * map.nx + i);
      let colour = [200, 200, 200];
      if (!isNaN(value)) {
        if (colours === "states") colour = STATES[Math.min(Math.max(Math.round(value), 0), 2)][1];
        else {
          // The first colour of the pressure is that of no contact.
          const least = colours === "pressure" && value > 0 ? 1 : 0;
          const k = 3 * Math.min(Math.max(Math.round((value - low) * scale), least), 255);
          colour = [lut[k], lut[k + 1], lut[k + 2]];
        }
      }
      image.data[to] = colour[0];
      image.data[to + 1] = colour[1];
      image.data[to + 2] = colour[2];
      image.data[to + 3] = 255;
    }
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

/** A canvas as sharp as the screen; returns its context in CSS pixels and its size. */
function sharp(canvas, ratio) {
  const dots = window.devicePixelRatio || 1;
  const width = canvas.clientWidth || 300, height = Math.round(width * ratio);
  canvas.style.height = height + "px";
  canvas.width = Math.round(width * dots);
  canvas.height = Math.round(height * dots);
  const context = canvas.getContext("2d");
  context.setTransform(dots, 0, 0, dots, 0, 0);
  return [context, width, height];
}

/** One map with its bar: what = {map, colours, low, high, unit, label}. */
class MapView {
  constructor(canvas, bar) {
    this.canvas = canvas;
    this.bar = bar;
    onWidth(canvas.parentElement, () => this.what && this.render());
  }

  show(what, line) {
    this.what = what;
    this.line = line;
    this.render();
  }

  render() {
    const { map, colours, low, high, unit, label } = this.what;
    const [lx, ly] = state.grid.size;
    // Over x and time the height is free.
    const [context, width, height] = sharp(this.canvas, state.grid.line ? 0.6 : Math.min(Math.max(ly / lx, 0.12), 2.5));
    const image = picture(map, colours, low, high);
    context.imageSmoothingEnabled = map.nx > width;
    context.drawImage(image, 0, 0, width, height);
    if (!state.grid.line) this.scaleBar(context, width, height, lx);
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
    this.colourBar(height, colours, low, high, unit, label);
  }

  scaleBar(context, width, height, length) {
    if (height < 60) return;
    const rough = 0.27 * length, tens = Math.pow(10, Math.floor(Math.log10(rough) + 1e-9));
    const round = [5, 2, 1].find((k) => k * tens <= rough * (1 + 1e-9)) * tens;
    const text = words(round, "m"), long = (width * round) / length;
    context.font = "12px system-ui, sans-serif";
    const wide = Math.max(long, context.measureText(text).width) + 12;
    context.fillStyle = "rgba(255,255,255,.82)";
    context.fillRect(8, height - 36, wide, 28);
    context.fillStyle = "#111";
    context.fillRect(8 + (wide - long) / 2, height - 15, long, 4);
    context.textAlign = "center";
    context.fillText(text, 8 + wide / 2, height - 20);
  }

  colourBar(tall, colours, low, high, unit, label) {
    const canvas = this.bar, dots = window.devicePixelRatio || 1;
    const width = canvas.clientWidth || 70, height = Math.max(tall, 120);
    canvas.style.height = height + "px";
    canvas.width = width * dots;
    canvas.height = height * dots;
    const context = canvas.getContext("2d");
    context.setTransform(dots, 0, 0, dots, 0, 0);
    context.font = "12px system-ui, sans-serif";
    context.fillStyle = css("--ink");
    if (colours === "states") {
      STATES.forEach(([name, colour], k) => {
        const y = 6 + 40 * k;
        context.fillStyle = `rgb(${colour})`;
        context.fillRect(0, y, 14, 14);
        context.strokeStyle = css("--soft");
        context.strokeRect(0.5, y + 0.5, 13, 13);
        context.fillStyle = css("--ink");
        name.split(" ").forEach((word, n) => context.fillText(word, 19, y + 11 + 13 * n));
      });
      return;
    }
    const lut = LUT[colours], [top, bottom] = [24, height - 8];
    for (let y = top; y < bottom; y++) {
      const k = 3 * Math.round((255 * (bottom - 1 - y)) / (bottom - 1 - top));
      context.fillStyle = `rgb(${lut[k]},${lut[k + 1]},${lut[k + 2]})`;
      context.fillRect(0, y, 13, 1.5);
    }
    const shownUnit = shown(unit, Math.max(Math.abs(low), Math.abs(high)));
    context.fillStyle = css("--ink");
    context.fillText(shownUnit.text || label, 0, 13);
    const [a, b] = [low * shownUnit.factor, high * shownUnit.factor];
    for (const { value, text } of ticks(a, b, (bottom - top) / 40, false)) {
      const y = bottom - ((value - a) / (b - a)) * (bottom - top);
      context.fillRect(13, y - 0.5, 4, 1);
      context.fillText(text, 20, y + 4);
    }
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
