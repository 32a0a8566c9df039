// Curves over two axes, drawn by uPlot: a drag zooms, a double click shows all again, the legend has the values at the
// cursor and switches curves off and on.

const charts = [];
const FONT = "12px system-ui, sans-serif";

/** The value that the unit of a logarithmic axis suits: its middle if it spans decades, 1 if it spans many on both sides of 1. */
function suited(low, high) {
  const decades = Math.log10(high / low);
  if (decades > 6 && low < 1 && high > 1) return 1;
  return decades > 3 ? Math.sqrt(low * high) : high;
}

/** Room between the curves and the frame, as shares of what the axes show. */
const ROOM = { x: 0.02, y: 0.05 };

/** Ends of an axis for values from `low` to `high`, with `room` on both sides. */
function ends(low, high, log, room) {
  // What differs by rounding only is one value.
  if (high - low <= 1e-9 * Math.max(Math.abs(low), Math.abs(high))) {
    if (log) return [low / 2, high * 2];
    return low === 0 ? [-room, 1] : [low - 0.1 * Math.abs(low), high + 0.1 * Math.abs(high)];
  }
  if (log) return [low * Math.pow(low / high, room), high * Math.pow(high / low, room)];
  return [low - room * (high - low), high + room * (high - low)];
}

/** A curve whose x goes back and forth. */
function track(u, k) {
  const path = new Path2D();
  let pen = false;
  uPlot.orient(u, k, (series, xs, ys, scaleX, scaleY, toX, toY, left, top, width, height) => {
    for (let n = 0; n < xs.length; n++) {
      const at = xs[n] === null || ys[n] === null ? null : [toX(xs[n], scaleX, width, left), toY(ys[n], scaleY, height, top)];
      if (at) path[pen ? "lineTo" : "moveTo"](...at);
      pen = at !== null;
    }
  });
  return { stroke: path, fill: null, clip: null, band: null, gaps: null, flags: 1 };
}

/**
 * One chart in `host`, of {title, note, x: {label, unit, log}, y: {label, unit, log, states}, series: [{name, x, y, points, dashed}],
 * free, events: [{at, text}], zero, none}. All series have the same x. `free`: x is not sorted. `states`: names of the values
 * 0, 1, 2 ... that are held from one x to the next. `zero` and `none` are the
 * words in place of curves that are zero throughout, or that have no value.
 * Charts with the same `shared` have one cursor and one zoom along x; `pick` is called with the x of a click.
 */
class Chart {
  constructor(host, spec, { shared = null, pick = null } = {}) {
    this.shared = shared;
    this.pick = pick;
    this.chosen = {};
    this.hidden = new Set();
    // Ends of the axes of a zoom; null for all of the curves.
    this.view = { x: null, y: null };
    this.heading = make("h3");
    this.switches = make("span", { class: "switches", role: "group", "aria-label": "Axes" });
    this.legend = make("div", { class: "legend", "aria-live": "polite" });
    this.plot = make("div", { class: "plot", tabindex: "0", role: "img" });
    this.note = make("p", { class: "note" });
    this.box = make("div", { class: spec.free ? "chart free" : "chart" }, make("div", { class: "head" }, this.heading, this.switches), this.legend, this.plot, this.note);
    host.append(this.box);
    this.plot.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!step || !this.uplot) return;
      event.preventDefault();
      this.step(step);
    });
    this.set(spec);
    onWidth(this.box, () => {
      this.uplot?.setSize(this.size());
      this.reserve();
    });
    charts.push(this);
  }

  /** Draws these curves; the zoom and the curves that are switched off stay. */
  set(spec) {
    this.spec = spec;
    this.heading.textContent = spec.title || "";
    this.plot.setAttribute("aria-label", `${spec.title || spec.y.label} over ${spec.x.label}; arrow keys read values`);
    if (!this.uplot || this.words() || this.drawn !== this.form()) return this.build();
    this.notes();
    this.uplot.setData(this.data());
  }

  /** The note of the chart, and what a logarithmic axis leaves out. */
  notes() {
    const { x, series, note } = this.spec;
    const zero = this.isLog("x") && series.some((one) => one.x.some((at, n) => at === 0 && isFinite(one.y[n])));
    this.note.textContent = [note, zero && !this.words() ? `Not shown: ${x.label} = 0.` : ""].filter(Boolean).join(" ");
    this.note.hidden = !this.note.textContent;
  }

  /** A logarithmic or linear axis. */
  use(key, log) {
    this.chosen[key] = log;
    this.build();
  }

  /** A dashed line at a place along x; null for none. */
  mark(x) {
    this.marked = x;
    this.lines();
  }

  /** Shows x from `low` to `high`; all of it without ends. */
  window(low, high) {
    this.zoom(low === undefined ? { x: null, y: null } : { x: [low, high], y: null });
  }

  /** Shows what lies between these ends of x and y; all of an axis whose ends are null. */
  zoom(view) {
    this.view = view;
    this.uplot?.setData(this.uplot.data);
  }

  /** The charts that have one zoom along x with this one, itself among them. */
  group() {
    return this.shared ? charts.filter((chart) => chart.shared === this.shared) : [this];
  }

  /** Shows what a drag has selected; a drag along one axis leaves the other as it is. */
  selected(u) {
    const { left, top, width, height } = u.select;
    if (Chart.dragged !== this || !(width > 0 && height > 0)) return;
    const across = width < u.over.clientWidth - 1, up = height < u.over.clientHeight - 1;
    const x = across ? [u.posToVal(left, "x"), u.posToVal(left + width, "x")] : this.view.x;
    const y = up ? [u.posToVal(top + height, "y"), u.posToVal(top, "y")] : this.view.y;
    u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.group().forEach((chart) => chart.zoom({ x, y: chart === this ? y : chart.view.y }));
  }

  isLog(key) {
    return (this.chosen[key] ?? this.spec[key].log ?? false) && this.canLog(key);
  }

  canLog(key) {
    return !this.spec[key].linear && this.spec.series.some((series) => series[key].some((value) => value > 0));
  }

  /** What the axes are. */
  axes() {
    const words = (key) => [this.spec[key].label, this.spec[key].unit, this.isLog(key), this.canLog(key)].join();
    return { x: words("x"), y: words("y") };
  }

  /** All that decides how the chart is built, besides its numbers. */
  form() {
    const { x, y } = this.axes();
    return [x, y, ...this.spec.series.map((series) => series.name)].join();
  }

  /** What stands in place of the curves: null where there is something to draw. */
  words() {
    const { series, zero, none, x } = this.spec;
    const values = series.flatMap((one) => Array.from(one.y).filter((value, n) => isFinite(value) && isFinite(one.x[n])));
    if (!values.length) return none ?? "There is no value to draw.";
    if (zero && values.every((value) => value === 0)) return zero;
    if (this.isLog("x") && !series[0].x.some((value) => value > 0)) return `No ${x.label} above zero.`;
    return null;
  }

  /** The columns of uPlot; null where an axis has no place for a value. */
  data() {
    const { series, free } = this.spec, [logX, logY] = [this.isLog("x"), this.isLog("y")];
    const place = (value, log) => (isFinite(value) && (!log || value > 0) ? value : null);
    const x = Array.from(series[0].x, (value) => place(value, logX));
    const y = series.map((one) => Array.from(one.y, (value) => place(value, logY)));
    const shown = x.filter((value) => value !== null);
    this.whole = ends(shown.reduce((a, b) => Math.min(a, b), Infinity), shown.reduce((a, b) => Math.max(a, b), -Infinity), logX, ROOM.x);
    if (free) return [null, ...y.map((values) => [x, values])];
    return [x, ...y].map((values) => values.filter((_, n) => x[n] !== null));
  }

  size() {
    const width = Math.max(this.box.clientWidth, 200);
    return { width, height: Math.round(Math.min(Math.max(width * 0.52, 220), 300)) };
  }

  /** Ticks of an axis as it is shown now: values in SI and texts in the unit shown. */
  ticks(u, key) {
    const { min, max } = u.scales[key], { states } = this.spec[key];
    if (states) return states.map((text, value) => ({ value, text }));
    const unit = this.unit(u, key);
    const length = (key === "x" ? u.bbox.width : u.bbox.height) / (window.devicePixelRatio || 1);
    return ticks(min * unit.factor, max * unit.factor, length / (key === "x" ? 70 : 38), this.isLog(key))
      .map(({ value, text }) => ({ value: value / unit.factor, text }));
  }

  unit(u, key) {
    const { min, max } = u.scales[key], log = this.isLog(key);
    const largest = log ? suited(min, max) : Math.max(Math.abs(min), Math.abs(max));
    return shownOnAxis(this.spec[key].unit || "", largest, log);
  }

  axis(key) {
    const rule = () => css("--rule");
    return {
      scale: key, side: key === "x" ? 2 : 3, font: FONT, labelFont: FONT, stroke: () => css("--ink"),
      size: key === "x" ? 24 : (u, values) => Math.max(50, 14 + 6.5 * Math.max(...(values ?? [""]).map((text) => text.length))), gap: 5, labelSize: 20, labelGap: 0,
      grid: { stroke: rule, width: 1 }, ticks: { show: false }, border: { show: true, stroke: rule, width: 1 },
      label: (u) => { const { text } = this.unit(u, key); return this.spec[key].label + (text ? ` [${text}]` : ""); },
      splits: (u) => this.ticks(u, key).map((tick) => tick.value),
      values: (u) => this.ticks(u, key).map((tick) => tick.text),
      filter: (u, splits) => splits,
    };
  }

  options() {
    const { spec } = this, { x, y, free } = spec;
    const facets = [{ scale: "x", auto: true, sorted: 0 }, { scale: "y", auto: true, sorted: 0 }];
    const value = (u, v, k, n) => {
      if (n === null || n === undefined) return "";
      const [at, is] = free ? [u.data[k][0][n], u.data[k][1][n]] : [null, v];
      const text = is === null || is === undefined ? "–" : y.states?.[is] ?? words(is, y.unit || "");
      return free ? `${text} at ${words(at, x.unit || "")}` : text;
    };
    const series = spec.series.map((one, k) => ({
      label: one.name || y.label, show: !this.hidden.has(one.name), scale: "y", width: 1.8, value,
      stroke: () => css(`--c${k % 4}`), dash: one.dashed ? [6, 4] : undefined,
      ...(free ? { facets, paths: track } : {}), ...(y.states ? { paths: uPlot.paths.stepped({ align: 1 }) } : {}), ...(one.points ? { paths: () => null } : {}),
      points: one.points ? { show: true, size: 5, width: 1.2, fill: () => css("--paper") } : free ? { show: false } : { size: 4, space: 14, fill: () => css(`--c${k % 4}`) },
    }));
    return {
      ...this.size(), mode: free ? 2 : 1, padding: [8, 14, 0, 0], pxAlign: 0,
      scales: {
        x: { time: false, distr: this.isLog("x") ? 3 : 1, range: () => this.view.x ?? this.whole },
        y: { distr: this.isLog("y") ? 3 : 1, range: (u, low, high) => this.view.y ?? (y.states ? [-0.2, y.states.length - 0.8] : low === null ? [1, 10] : ends(low, high, this.isLog("y"), ROOM.y)) },
      },
      axes: [this.axis("x"), this.axis("y")],
      series: [free ? {} : { label: x.label, value: (u, v) => (v === null || v === undefined ? "" : words(v, x.unit || "")) }, ...series],
      legend: {
        mount: (u, table) => this.legend.replaceChildren(table),
        markers: { width: 3, stroke: (u, k) => `var(--c${(k - 1) % 4})`, fill: () => "none", dash: (u, k) => (spec.series[k - 1].dashed ? "dashed" : spec.series[k - 1].points ? "dotted" : "solid") },
      },
      cursor: {
        y: false, points: { size: 8, width: 0, stroke: (u, k) => css(`--c${(k - 1) % 4}`), fill: (u, k) => css(`--c${(k - 1) % 4}`) },
        // The ends of a zoom are kept here: uPlot does not take ends that lie less than 1e-16 apart, as those of leak rates do.
        drag: { x: true, y: true, uni: 24, dist: 4, setScale: false },
        bind: { dblclick: () => () => this.group().forEach((chart) => chart.window()) },
        ...(free ? { dataIdx: (u, k) => this.nearest(u, k) } : {}),
        ...(this.shared ? { sync: { key: this.shared, scales: ["x", null] } } : {}),
      },
      hooks: {
        setSeries: [(u, k) => { if (k === null) return; const { name } = spec.series[k - 1]; u.series[k].show ? this.hidden.delete(name) : this.hidden.add(name); }],
        setSelect: [(u) => this.selected(u)],
        draw: [() => { this.lines(); this.back && (this.back.hidden = !this.zoomed()); }],
      },
    };
  }

  zoomed() {
    return Boolean(this.view.x || this.view.y);
  }

  build() {
    this.uplot?.destroy();
    this.uplot = null;
    const now = this.axes();
    for (const key of ["x", "y"]) if (this.drawnAxes?.[key] !== now[key]) this.view[key] = null;
    [this.drawn, this.drawnAxes] = [this.form(), now];
    const words = this.words();
    this.notes();
    this.buttons(words ? [] : ["x", "y"]);
    this.plot.replaceChildren(...(words ? [make("p", { class: "empty" }, words)] : []));
    if (words) return this.legend.replaceChildren();
    this.uplot = new uPlot(this.options(), this.data(), this.plot);
    this.reserve();
    this.uplot.over.addEventListener("mousedown", () => (Chart.dragged = this));
    this.uplot.over.addEventListener("click", () => this.pick?.(this.uplot.posToVal(this.uplot.cursor.left, "x")));
    for (const name of this.legend.querySelectorAll(this.spec.free ? "th" : "tr:not(:first-child) th, .u-series:only-child th")) {
      name.tabIndex = 0;
      name.title = "Hide or show this curve";
      name.addEventListener("keydown", (event) => (event.key === "Enter" || event.key === " ") && (event.preventDefault(), name.click()));
    }
  }

  /** Room for the legend with values, so that the chart stays where it is when they appear. */
  reserve() {
    if (!this.uplot) return;
    this.legend.style.minHeight = "";
    const { data, legend } = this.uplot, idxs = [...legend.idxs];
    this.uplot.setLegend({ idx: (this.spec.free ? data[1][0] : data[0]).length - 1 });
    this.legend.style.minHeight = `${this.legend.offsetHeight}px`;
    this.uplot.setLegend({ idxs });
  }

  /** Switches of the axes, and the way back from a zoom. */
  buttons(keys) {
    const one = (key) => {
      const button = make("button", { type: "button", class: "small", "aria-pressed": String(this.isLog(key)), "data-log": key, title: `Logarithmic ${this.spec[key].label}` }, `log ${key}`);
      button.addEventListener("click", () => this.use(key, !this.isLog(key)));
      return button;
    };
    this.back = make("button", { type: "button", class: "small back" }, "show all");
    this.back.hidden = true;
    this.back.addEventListener("click", () => {
      this.group().forEach((chart) => chart.window());
    });
    this.switches.replaceChildren(this.back, ...keys.filter((key) => this.canLog(key)).map(one));
  }

  /** The point of a free curve that is nearest to the cursor. */
  nearest(u, k) {
    const [xs, ys] = u.data[k], { left, top } = u.cursor;
    let best = null, least = Infinity;
    for (let n = 0; n < xs.length; n++) {
      if (xs[n] === null || ys[n] === null) continue;
      const far = Math.hypot(u.valToPos(xs[n], "x") - left, u.valToPos(ys[n], "y") - top);
      if (far < least) [best, least] = [n, far];
    }
    return best;
  }

  /** The cursor at the next point, or the first or last one. */
  step(by) {
    const u = this.uplot, [xs, ys] = this.spec.free ? u.data[1] : [u.data[0], u.data[1]];
    const last = xs.length - 1, now = u.cursor.left >= 0 ? u.legend.idxs.find((n) => n !== null && n !== undefined) : undefined;
    const at = now === undefined ? (by > 0 ? 0 : last) : Math.min(Math.max(now + by, 0), last);
    u.setCursor({ left: u.valToPos(xs[at], "x"), top: Math.max(u.valToPos(ys[at] ?? u.scales.y.min, "y"), 0) }, true, true);
  }

  /** The events and the mark, as lines behind the curves. */
  lines() {
    const u = this.uplot;
    if (!u) return;
    u.under.replaceChildren();
    const line = (at, name, text) => {
      if (this.isLog("x") && !(at > 0)) return null;
      const left = u.valToPos(at, "x");
      // Near the right border the words stand before their line.
      const side = left + 7 * text.length > u.under.clientWidth ? { class: "before" } : {};
      if (isFinite(left)) u.under.append(make("i", { class: name, style: `left: ${left.toFixed(1)}px` }, ...(text ? [make("span", side, text)] : [])));
      return left;
    };
    let free = -Infinity;
    for (const { at, text } of this.spec.events ?? []) {
      const room = u.valToPos(at, "x") >= free;
      const left = line(at, "event", room ? text : "");
      if (room && left !== null && left >= 0) free = left + 7 * text.length + 10;
    }
    if (this.marked !== undefined && this.marked !== null) line(this.marked, "mark", "");
  }
}
