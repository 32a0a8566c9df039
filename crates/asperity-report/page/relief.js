// The deformed surface in three dimensions: quadrilaterals, the farthest first, above a frame with the sizes.

class Relief {
  constructor(canvas, bar) {
    this.canvas = canvas;
    this.bar = bar;
    this.turn = 0.7;
    this.tilt = 0.55;
    canvas.addEventListener("pointerdown", (event) => {
      this.from = [event.clientX, event.clientY];
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!this.from || !event.buttons) return;
      this.rotate((event.clientX - this.from[0]) * 0.01, (event.clientY - this.from[1]) * 0.008);
      this.from = [event.clientX, event.clientY];
    });
    canvas.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.08], ArrowDown: [0, 0.08] }[event.key];
      if (!step) return;
      event.preventDefault();
      this.rotate(...step);
    });
    onWidth(canvas.parentElement, () => this.z && this.render());
  }

  rotate(turn, tilt) {
    this.turn += turn;
    this.tilt = Math.min(Math.max(this.tilt + tilt, 0.1), 1.5);
    requestAnimationFrame(() => this.render());
  }

  /** Heights z and the values that colour them, of nx by ny cells, with the colours of a map; each axis thinned to what a screen shows in good time. */
  show(nx, ny, z, values, what) {
    const [thinX, thinY] = [nx, ny].map((cells) => Math.max(1, Math.ceil(cells / 128)));
    this.nx = Math.floor((nx - 1) / thinX) + 1;
    this.ny = Math.floor((ny - 1) / thinY) + 1;
    this.z = new Float32Array(this.nx * this.ny);
    this.entries = new Uint16Array(this.nx * this.ny);
    for (let i = 0; i < this.nx; i++) {
      for (let j = 0; j < this.ny; j++) {
        const from = i * thinX * ny + j * thinY;
        this.z[i * this.ny + j] = z[from];
        this.entries[i * this.ny + j] = entry(what, values[from], false);
      }
    }
    const finite = this.z.filter((value) => !isNaN(value));
    this.low = finite.reduce((a, b) => Math.min(a, b), Infinity);
    this.high = finite.reduce((a, b) => Math.max(a, b), -Infinity);
    this.what = what;
    this.fills = palette(what.colours);
    // Without contact the surface is grey in place of almost white.
    [150, 158, 166].forEach((part, k) => (this.fills[3 * NO_CONTACT + k] = part));
    this.render();
  }

  /** Heights of the picture as a share of the longer side; how much they are stretched. */
  static height = 0.3;
  stretch() {
    return (Relief.height * Math.max(...state.grid.size)) / (this.high - this.low);
  }

  /** The sides of the area as shares of the longer one, and how many times each is stretched: a narrow area would be a line. */
  static narrowest = 1 / 6;
  sides() {
    const [lx, ly] = state.grid.size, long = Math.max(lx, ly);
    return [lx, ly].map((length) => {
      const side = Math.max(length / long, Relief.narrowest);
      return { side, times: side / (length / long) };
    });
  }

  /** "x stretched 12 times" for a narrow area; empty for others. */
  sidesNote() {
    const k = this.sides().findIndex(({ times }) => times > 1);
    return k < 0 ? "" : `, ${"xy"[k]} ${digits(Number(this.sides()[k].times.toPrecision(2)))} times`;
  }

  /** Turns a place, in shares of the longer side from the middle, into pixels and the distance from the viewer. */
  camera(width, height) {
    const [c, s, ct, st] = [Math.cos(this.turn), Math.sin(this.turn), Math.cos(this.tilt), Math.sin(this.tilt)];
    const size = Math.min(width / 1.6, (height - 30) / (1.42 * st + 0.3 * ct));
    return (x, y, up) => {
      const [a, b] = [x * c - y * s, x * s + y * c];
      return [width / 2 + size * a, height / 2 - 6 - size * (b * st + up * ct), b];
    };
  }

  render() {
    const height = Math.round(Math.max((this.canvas.clientWidth || 300) * 0.55, 230)), [context, width] = sharp(this.canvas, height);
    context.clearRect(0, 0, width, height);
    const { nx, ny, z, low, high } = this;
    const place = this.camera(width, height), lift = high > low ? Relief.height / (high - low) : 0;
    const [halfX, halfY] = this.sides().map(({ side }) => 0.5 * side);
    const px = new Float32Array(nx * ny), py = new Float32Array(nx * ny);
    for (let i = 0, n = 0; i < nx; i++) {
      for (let j = 0; j < ny; j++, n++) {
        const [x, y] = [(i / Math.max(nx - 1, 1) - 0.5) * 2 * halfX, (j / Math.max(ny - 1, 1) - 0.5) * 2 * halfY];
        [px[n], py[n]] = place(x, y, (z[n] - 0.5 * (low + high)) * lift);
      }
    }
    const order = (count, ascending) => Array.from({ length: count }, (_, k) => (ascending ? k : count - 1 - k));
    // Back to front along both directions: the distance x s + y c grows away from the viewer.
    for (const i of order(nx - 1, Math.sin(this.turn) < 0)) {
      for (const j of order(ny - 1, Math.cos(this.turn) < 0)) {
        const corners = [i * ny + j, (i + 1) * ny + j, (i + 1) * ny + j + 1, i * ny + j + 1];
        if (corners.some((n) => isNaN(z[n]))) continue;
        const slope = (z[corners[1]] - z[corners[0]]) * lift * nx - (z[corners[3]] - z[corners[0]]) * lift * ny;
        const light = Math.min(Math.max(0.86 + 0.22 * slope, 0.45), 1.1);
        const from = 3 * this.entries[corners[0]], [r, g, b] = this.fills.slice(from, from + 3);
        context.fillStyle = `rgb(${r * light},${g * light},${b * light})`;
        context.strokeStyle = context.fillStyle;
        context.lineWidth = 0.6;
        context.beginPath();
        context.moveTo(px[corners[0]], py[corners[0]]);
        for (const n of corners.slice(1)) context.lineTo(px[n], py[n]);
        context.closePath();
        context.fill();
        context.stroke();
      }
    }
    this.sizes(context, width, place, halfX, halfY);
    colourBar(this.bar, height, { ...this.what, swatches: this.what.colours === "pressure" ? [[[150, 158, 166], "no contact"]] : [] });
  }

  /** The two front edges of the area with their lengths, and the range of the heights as an upright bar. */
  sizes(context, width, place, halfX, halfY) {
    const [lx, ly] = state.grid.size, base = -0.5 * Relief.height;
    const corners = [[-halfX, -halfY], [halfX, -halfY], [halfX, halfY], [-halfX, halfY]];
    const nearest = corners.reduce((best, corner, k) => (place(...corner, base)[2] < place(...corners[best], base)[2] ? k : best), 0);
    context.strokeStyle = context.fillStyle = css("--ink");
    context.lineWidth = 1.2;
    const line = (from, to) => {
      context.beginPath();
      context.moveTo(from[0], from[1]);
      context.lineTo(to[0], to[1]);
      context.stroke();
    };
    const front = place(...corners[nearest], base);
    for (const step of [1, 3]) {
      const other = corners[(nearest + step) % 4], end = place(...other, base), right = end[0] > front[0];
      line(front, end);
      const text = other[1] === corners[nearest][1] ? `x ${words(lx, "m")}` : `y ${words(ly, "m")}`;
      context.textAlign = right ? "left" : "right";
      context.fillText(text, 0.5 * (front[0] + end[0]) + (right ? 8 : -8), 0.5 * (front[1] + end[1]) + 16);
      if (!right || this.high <= this.low) continue;
      const top = place(...other, base + Relief.height), tall = words(this.high - this.low, "m");
      line(end, top);
      context.textAlign = "left";
      context.fillText(tall, Math.min(top[0] - 12, width - context.measureText(tall).width - 2), top[1] - 6);
    }
  }
}
