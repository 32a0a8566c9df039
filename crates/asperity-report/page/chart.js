// Curves over two axes: hover or arrow keys give values.

const SVG = "http://www.w3.org/2000/svg";
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const charts = [];

/** An element with attributes and children. */
function make(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}

/** Calls `draw` after the width of an element has changed. */
function onWidth(element, draw) {
  let width = 0;
  new ResizeObserver(() => requestAnimationFrame(() => {
    if (element.clientWidth === width) return;
    width = element.clientWidth;
    draw();
  })).observe(element);
}

function draw(parent, name, attributes, text) {
  const node = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  if (text !== undefined) node.textContent = text;
  parent.append(node);
  return node;
}

/** One chart in `host`: {title, x: {label, unit, log}, y: {label, unit, log}, series: [{name, x, y, points}]}. */
class Chart {
  constructor(host, spec) {
    this.spec = spec;
    this.at = null;
    this.legend = make("div", { class: "legend", "aria-live": "polite" });
    this.svg = document.createElementNS(SVG, "svg");
    this.svg.setAttribute("tabindex", "0");
    this.svg.setAttribute("role", "img");
    this.svg.setAttribute("aria-label", `${spec.title || spec.y.label} over ${spec.x.label}; arrow keys read values`);
    this.box = make("div", { class: "chart" }, make("h3", {}, spec.title || ""), this.legend, this.svg);
    host.append(this.box);
    this.svg.addEventListener("pointermove", (event) => this.point(event));
    this.svg.addEventListener("pointerleave", () => this.read(null));
    this.svg.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!step) return;
      event.preventDefault();
      const last = this.spec.series[0].x.length - 1;
      this.read(this.at === null ? (step > 0 ? 0 : last) : Math.min(Math.max(this.at + step, 0), last));
    });
    this.render();
    onWidth(this.box, () => this.render());
    charts.push(this);
  }

  set(spec) {
    this.spec = spec;
    this.at = null;
    this.render();
  }

  /** A mark at a place along x, or null. */
  mark(x) {
    this.marked = x;
    this.render();
  }

  axis(axis, key, length) {
    let low = Infinity, high = -Infinity;
    for (const series of this.spec.series) {
      for (let n = 0; n < series.x.length; n++) {
        const [x, y] = [series.x[n], series.y[n]];
        if (!isFinite(x) || !isFinite(y) || (this.spec.x.log && x <= 0) || (this.spec.y.log && y <= 0)) continue;
        const value = key === "x" ? x : y;
        low = Math.min(low, value);
        high = Math.max(high, value);
      }
    }
    if (low > high) [low, high] = axis.log ? [1, 10] : [0, 1];
    // What differs by rounding only is one value.
    if (high - low <= 1e-9 * Math.max(Math.abs(low), Math.abs(high))) [low, high] = axis.log ? [low / 2, high * 2] : low === 0 ? [0, 1] : [low - 0.1 * Math.abs(low), high + 0.1 * Math.abs(high)];
    const unit = shown(axis.unit || "", Math.max(Math.abs(low), Math.abs(high)));
    [low, high] = [low * unit.factor, high * unit.factor];
    const forward = axis.log ? Math.log10 : (v) => v;
    if (key === "y") {
      const room = 0.05 * (forward(high) - forward(low));
      const backward = axis.log ? (v) => Math.pow(10, v) : (v) => v;
      low = !axis.log && low === 0 ? 0 : backward(forward(low) - room);
      high = !axis.log && high === 0 ? 0 : backward(forward(high) + room);
    }
    const [a, b] = [forward(low), forward(high)];
    const place = (v) => ((!axis.log || v > 0) ? ((forward(v * unit.factor) - a) / (b - a)) * length : NaN);
    return { unit, place, ticks: ticks(low, high, length / (key === "x" ? 70 : 38), axis.log), title: axis.label + (unit.text ? ` [${unit.text}]` : "") };
  }

  render() {
    const width = Math.max(this.box.clientWidth, 200), height = Math.round(Math.min(Math.max(width * 0.52, 180), 300));
    const [left, right, top, bottom] = [64, 10, 8, 42];
    const [w, h] = [width - left - right, height - top - bottom];
    const svg = this.svg;
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.style.height = height + "px";
    const x = this.axis(this.spec.x, "x", w), y = this.axis(this.spec.y, "y", h);
    const rule = css("--rule"), soft = css("--soft");
    for (const { value, text } of x.ticks) {
      const at = left + x.place(value / x.unit.factor);
      draw(svg, "line", { x1: at, x2: at, y1: top, y2: top + h, stroke: rule });
      draw(svg, "text", { x: at, y: top + h + 16, "text-anchor": "middle" }, text);
    }
    for (const { value, text } of y.ticks) {
      const at = top + h - y.place(value / y.unit.factor);
      draw(svg, "line", { x1: left, x2: left + w, y1: at, y2: at, stroke: rule });
      draw(svg, "text", { x: left - 6, y: at + 4, "text-anchor": "end" }, text);
    }
    draw(svg, "rect", { x: left, y: top, width: w, height: h, fill: "none", stroke: soft });
    draw(svg, "text", { x: left + w / 2, y: height - 6, "text-anchor": "middle" }, x.title);
    draw(svg, "text", { x: 13, y: top + h / 2, "text-anchor": "middle", transform: `rotate(-90 13 ${top + h / 2})` }, y.title);
    this.where = (n, series) => [left + x.place(series.x[n]), top + h - y.place(series.y[n])];
    if (this.marked !== undefined && this.marked !== null) {
      const at = left + x.place(this.marked);
      if (isFinite(at)) draw(svg, "line", { x1: at, x2: at, y1: top, y2: top + h, stroke: css("--mark"), "stroke-dasharray": "4 3", class: "mark" });
    }
    this.spec.series.forEach((series, k) => {
      const colour = css(`--c${k % 4}`);
      let path = "", pen = "M";
      for (let n = 0; n < series.x.length; n++) {
        const [a, b] = this.where(n, series);
        if (!isFinite(a) || !isFinite(b)) { pen = "M"; continue; }
        if (series.points) draw(svg, "circle", { cx: a.toFixed(1), cy: b.toFixed(1), r: 2.2, fill: "none", stroke: colour });
        else { path += `${pen}${a.toFixed(1)} ${b.toFixed(1)}`; pen = "L"; }
      }
      if (path) draw(svg, "path", { d: path, fill: "none", stroke: colour, "stroke-width": 1.8, "stroke-linejoin": "round", "stroke-dasharray": series.dashed ? "6 4" : "none" });
    });
    this.cursor = draw(svg, "g", {});
    this.read(this.at);
  }

  point(event) {
    const box = this.svg.getBoundingClientRect();
    const scale = this.svg.viewBox.baseVal.width / box.width;
    const [px, py] = [(event.clientX - box.left) * scale, (event.clientY - box.top) * scale];
    const series = this.spec.series[0];
    let best = null, least = Infinity;
    for (let n = 0; n < series.x.length; n++) {
      const [a, b] = this.where(n, series);
      const distance = Math.abs(a - px) + (this.spec.free ? Math.abs(b - py) : 0);
      if (distance < least) [best, least] = [n, distance];
    }
    this.read(best);
  }

  /** Shows the values of point `n`, or the names only. */
  read(n) {
    this.at = n;
    if (!this.cursor) return;
    this.cursor.replaceChildren();
    this.legend.replaceChildren();
    const { x, y, series } = this.spec;
    if (n !== null && series[0] && n < series[0].x.length) this.legend.append(make("span", {}, `${x.label} ${words(series[0].x[n], x.unit || "")}`));
    series.forEach((one, k) => {
      const colour = `var(--c${k % 4})`;
      const fill = one.dashed ? `repeating-linear-gradient(90deg, ${colour} 0 4px, transparent 4px 7px)` : colour;
      const swatch = make("i", { style: `background: ${fill}` });
      let text = one.name || "";
      if (n !== null && n < one.x.length) {
        text += (text ? " " : "") + words(one.y[n], y.unit || "");
        const [a, b] = this.where(n, one);
        if (isFinite(a) && isFinite(b)) draw(this.cursor, "circle", { cx: a, cy: b, r: 4, fill: css(`--c${k % 4}`) });
      }
      if (text) this.legend.append(make("span", {}, swatch, text));
    });
  }
}
