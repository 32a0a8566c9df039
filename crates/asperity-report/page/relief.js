// The deformed surface in three dimensions: quadrilaterals, the farthest first.

class Relief {
  constructor(canvas) {
    this.canvas = canvas;
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

  /** Heights and colours (values 0 to 1) of nx by ny cells; thinned to what a screen shows in good time. */
  show({ nx, ny, z, shade, colours }) {
    const thin = Math.max(1, Math.ceil(Math.max(nx, ny) / 128));
    this.nx = Math.floor((nx - 1) / thin) + 1;
    this.ny = Math.floor((ny - 1) / thin) + 1;
    this.z = new Float32Array(this.nx * this.ny);
    this.shade = new Float32Array(this.nx * this.ny);
    for (let i = 0; i < this.nx; i++) {
      for (let j = 0; j < this.ny; j++) {
        const from = i * thin * ny + j * thin;
        this.z[i * this.ny + j] = z[from];
        this.shade[i * this.ny + j] = shade[from];
      }
    }
    this.colours = colours;
    this.render();
  }

  render() {
    const [context, width, height] = sharp(this.canvas, 0.55);
    context.clearRect(0, 0, width, height);
    const { nx, ny, z, shade } = this;
    const [lx, ly] = state.grid.size, long = Math.max(lx, ly);
    let low = Infinity, high = -Infinity;
    for (const value of z) if (!isNaN(value)) [low, high] = [Math.min(low, value), Math.max(high, value)];
    const lift = high > low ? 0.3 / (high - low) : 0;
    const [c, s, ct, st] = [Math.cos(this.turn), Math.sin(this.turn), Math.cos(this.tilt), Math.sin(this.tilt)];
    const size = Math.min(width / 1.45, height / (1.42 * st + 0.3 * ct));
    const px = new Float32Array(nx * ny), py = new Float32Array(nx * ny), depth = new Float32Array(nx * ny);
    for (let i = 0, n = 0; i < nx; i++) {
      for (let j = 0; j < ny; j++, n++) {
        const x = ((i / Math.max(nx - 1, 1) - 0.5) * lx) / long, y = ((j / Math.max(ny - 1, 1) - 0.5) * ly) / long;
        const [a, b] = [x * c - y * s, x * s + y * c];
        const up = (z[n] - 0.5 * (low + high)) * lift;
        px[n] = width / 2 + size * a;
        py[n] = height / 2 - size * (b * st + up * ct);
        depth[n] = b;
      }
    }
    const lut = LUT[this.colours];
    const order = (count, ascending) => Array.from({ length: count }, (_, k) => (ascending ? k : count - 1 - k));
    // Back to front along both directions: b = x s + y c grows away from the viewer.
    for (const i of order(nx - 1, s < 0)) {
      for (const j of order(ny - 1, c < 0)) {
        const corners = [i * ny + j, (i + 1) * ny + j, (i + 1) * ny + j + 1, i * ny + j + 1];
        if (corners.some((n) => isNaN(z[n]))) continue;
        const slope = (z[corners[1]] - z[corners[0]]) * lift * nx - (z[corners[3]] - z[corners[0]]) * lift * ny;
        const light = Math.min(Math.max(0.86 + 0.22 * slope, 0.45), 1.1);
        // Where nothing touches the surface is grey.
        const value = shade[corners[0]], k = 3 * Math.min(Math.max(Math.round(40 + 215 * value), 0), 255);
        const [r, g, b] = value > 0 ? [lut[k], lut[k + 1], lut[k + 2]] : [150, 158, 166];
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
    this.range = [low, high];
  }
}
