// 3-D views of damages: a grid of points in parallel projection, drawn from back to front.
(() => {
  "use strict";

  const palette = JSON.parse(document.getElementById("palette").textContent);
  const UNKNOWN = -32768;
  const START = { turn: -0.5, tilt: 0.85 };
  const LIGHT = [-0.45, 0.35, 0.82];
  const SHADES = 12;
  const STEP = Math.PI / 36;

  const colours = new Map();
  function colourOf(level, shade, speckled) {
    const key = (level * SHADES + shade) * 2 + (speckled ? 1 : 0);
    if (!colours.has(key)) {
      const light = 0.6 + (0.4 * shade) / (SHADES - 1);
      const mix = speckled ? 0.55 : 0;
      const channel = (value) => Math.round(light * (value * (1 - mix) + 90 * mix));
      colours.set(key, `rgb(${palette[level].map(channel).join(",")})`);
    }
    return colours.get(key);
  }

  function bytesOf(text) {
    return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  }

  function valuesOf(text, step) {
    const view = new DataView(bytesOf(text).buffer);
    const values = new Float64Array(view.byteLength / 2);
    for (let i = 0; i < values.length; ++i) {
      const whole = view.getInt16(2 * i, true);
      values[i] = whole === UNKNOWN ? NaN : whole * Number(step);
    }
    return values;
  }

  function readSurface(data) {
    const bits = bytesOf(data.measured);
    const surface = {
      columns: Number(data.columns), rows: Number(data.rows), unit: data.unit, maxDepth: Number(data.maxDepth),
      x: valuesOf(data.x, data.xStep), y: valuesOf(data.y, data.yStep), z: valuesOf(data.depth, data.depthStep),
      measured: (i) => (bits[i >> 3] >> (i & 7)) & 1,
    };
    surface.z.forEach((depth, i) => { surface.z[i] = -depth; });
    const last = surface.x.length - 1;
    const corners = [0, surface.columns - 1, last, last - surface.columns + 1];
    surface.corners = corners.map((i) => [surface.x[i], surface.y[i]]);
    surface.radius = Math.max(...surface.corners.map(([x, y]) => Math.hypot(x, y)));
    const known = surface.z.filter((z) => !Number.isNaN(z));
    surface.lowest = known.reduce((a, b) => Math.min(a, b), 0);
    surface.highest = known.reduce((a, b) => Math.max(a, b), 0);
    return surface;
  }

  /** Returns the exaggeration at which the depth is about a seventh of the width. */
  function goodExaggeration(surface) {
    const wanted = (0.28 * surface.radius) / surface.maxDepth;
    return Math.min(20, Math.max(1, Math.round(2 * wanted) / 2));
  }

  class View {
    constructor(canvas) {
      this.canvas = canvas;
      this.surface = readSurface(canvas.dataset);
      this.slider = canvas.parentElement.querySelector("input");
      this.output = canvas.parentElement.querySelector("output");
      this.slider.value = goodExaggeration(this.surface);
      this.pose = { ...START };
      this.listen();
      new ResizeObserver(() => this.draw()).observe(canvas);
      this.draw();
    }

    listen() {
      this.slider.addEventListener("input", () => this.draw());
      this.canvas.addEventListener("keydown", (event) => this.onKey(event));
      this.canvas.addEventListener("dblclick", () => this.reset());
      this.canvas.addEventListener("pointerdown", (event) => {
        this.canvas.setPointerCapture(event.pointerId);
        this.grip = { x: event.clientX, y: event.clientY, ...this.pose };
      });
      this.canvas.addEventListener("pointermove", (event) => {
        if (!this.grip) return;
        this.turnTo(this.grip.turn + (event.clientX - this.grip.x) / 120,
                    this.grip.tilt + (event.clientY - this.grip.y) / 120);
      });
      for (const end of ["pointerup", "pointercancel"]) {
        this.canvas.addEventListener(end, () => { this.grip = null; });
      }
    }

    onKey(event) {
      const turns = { ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0], ArrowUp: [0, STEP], ArrowDown: [0, -STEP] };
      if (event.key === "Home") this.reset();
      else if (turns[event.key]) this.turnTo(this.pose.turn + turns[event.key][0], this.pose.tilt + turns[event.key][1]);
      else return;
      event.preventDefault();
    }

    reset() { this.turnTo(START.turn, START.tilt); }

    /** tilt: 0 along the road, π/2 straight down. */
    turnTo(turn, tilt) {
      this.pose = { turn, tilt: Math.min(Math.PI / 2, Math.max(0.1, tilt)) };
      this.draw();
    }

    draw() {
      if (this.waiting) return;
      this.waiting = true;
      requestAnimationFrame(() => { this.waiting = false; this.paint(); });
    }

    paint() {
      const exaggeration = Number(this.slider.value);
      this.output.textContent = `${exaggeration} ×`;
      const ratio = Math.min(2, Math.max(1, window.devicePixelRatio || 1));
      const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
      if (width === 0 || height === 0) return;
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
      const context = this.canvas.getContext("2d");
      context.scale(ratio, ratio);
      context.fillStyle = "#fff";
      context.fillRect(0, 0, width, height);
      const project = this.projection(width, height, exaggeration);
      this.paintSurface(context, project, exaggeration);
      this.paintFrame(context, project);
    }

    /** Points on the canvas; `far` increases away from the viewer. */
    projection(width, height, exaggeration) {
      const { turn, tilt } = this.pose;
      const { radius, lowest, highest } = this.surface;
      const [c, s, lift, lower] = [Math.cos(turn), Math.sin(turn), Math.cos(tilt), Math.sin(tilt)];
      // Depths are largest near the middle; the corners of the road limit the drawing.
      const above = Math.max(0.95 * radius * lower, 0.5 * radius * lower + highest * exaggeration * lift);
      const below = Math.max(0.95 * radius * lower, 0.5 * radius * lower - lowest * exaggeration * lift);
      const scale = Math.min((width - 24) / (2 * radius), (height - 44) / (above + below));
      const middle = (height - 12 + scale * (above - below)) / 2;
      return (x, y, z) => {
        const right = c * x - s * y, away = s * x + c * y;
        return { x: width / 2 + scale * right, y: middle - scale * (away * lower + z * exaggeration * lift), far: away };
      };
    }

    paintSurface(context, project, exaggeration) {
      const { columns, rows, x, y, z } = this.surface;
      const points = Array.from(x, (value, i) => project(value, y[i], z[i]));
      const corner = (i) => project(x[i], y[i], 0).far;
      const rowsForth = corner(0) > corner((rows - 1) * columns);
      const columnsForth = corner(0) > corner(columns - 1);
      context.lineWidth = 0.7;
      for (let r = 0; r < rows - 1; ++r) {
        const row = rowsForth ? r : rows - 2 - r;
        for (let k = 0; k < columns - 1; ++k) {
          const at = row * columns + (columnsForth ? k : columns - 2 - k);
          this.paintCell(context, points, at, exaggeration);
        }
      }
    }

    paintCell(context, points, at, exaggeration) {
      const { columns, z, maxDepth, measured } = this.surface;
      const cell = [at, at + 1, at + columns + 1, at + columns];
      const height = (z[cell[0]] + z[cell[1]] + z[cell[2]] + z[cell[3]]) / 4;
      if (Number.isNaN(height)) return;
      const whole = cell.every(measured);
      const share = Math.min(1, Math.max(0, (1 - height / maxDepth) / 2));
      const speckled = !whole && (Math.floor(at / columns) + (at % columns)) % 2 === 0;
      const colour = colourOf(Math.round(share * (palette.length - 1)), this.shadeOf(cell, exaggeration), speckled);
      context.fillStyle = colour;
      context.strokeStyle = colour;
      context.beginPath();
      cell.forEach((i, k) => (k === 0 ? context.moveTo(points[i].x, points[i].y) : context.lineTo(points[i].x, points[i].y)));
      context.closePath();
      context.fill();
      context.stroke();
    }

    /** Shade of a cell from its angle to the light. */
    shadeOf(cell, exaggeration) {
      const { x, y, z } = this.surface;
      const across = (values, factor = 1) => [factor * (values[cell[2]] - values[cell[0]]), factor * (values[cell[1]] - values[cell[3]])];
      const [ax, bx] = across(x), [ay, by] = across(y), [az, bz] = across(z, exaggeration);
      const n = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
      const length = Math.hypot(...n) || 1;
      const light = (n[0] * LIGHT[0] + n[1] * LIGHT[1] + n[2] * LIGHT[2]) / length;
      return Math.round(Math.min(1, Math.max(0, light)) * (SHADES - 1));
    }

    /** The undamaged road as a dashed outline with the lengths of two sides. */
    paintFrame(context, project) {
      const { corners, unit } = this.surface;
      const points = corners.map(([x, y]) => project(x, y, 0));
      context.strokeStyle = "#1d2530";
      context.setLineDash([5, 4]);
      context.lineWidth = 1;
      context.beginPath();
      points.forEach((point, i) => (i === 0 ? context.moveTo(point.x, point.y) : context.lineTo(point.x, point.y)));
      context.closePath();
      context.stroke();
      context.setLineDash([]);
      context.font = "12px sans-serif";
      context.textAlign = "center";
      context.lineWidth = 3;
      context.strokeStyle = "#fff";
      context.fillStyle = "#1d2530";
      const nearest = points.map((point, i) => ({ i, far: point.far + points[(i + 1) % 4].far })).sort((a, b) => a.far - b.far);
      for (const { i } of nearest.slice(0, 2)) {
        const next = (i + 1) % 4;
        const length = Math.hypot(corners[i][0] - corners[next][0], corners[i][1] - corners[next][1]);
        const text = unit === "m" ? `${length.toFixed(2)} m` : `${length.toFixed(0)} px`;
        const point = [(points[i].x + points[next].x) / 2, (points[i].y + points[next].y) / 2 + 16];
        context.strokeText(text, ...point);
        context.fillText(text, ...point);
      }
    }
  }

  for (const canvas of document.querySelectorAll(".relief canvas")) new View(canvas);
})();
