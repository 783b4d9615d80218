/* Plot: one joint's curves, left and right. The curves are painted once per size; per frame only the cursor is. */

const MARGIN = { left: 38, right: 10, top: 22, bottom: 14 };
const FONT = "px system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";
const USUAL = 105; // height of a plot [px] at which text is 11 px; taller plots have larger text

function palette() {
  const css = getComputedStyle(document.documentElement);
  const names = ["left", "right", "ink", "muted", "line", "limit", "surface"];
  return Object.fromEntries(names.map((name) => [name, css.getPropertyValue(`--${name}`).trim()]));
}

class Plot {
  constructor(spec, motion, source, holder) {
    this.spec = spec;
    this.motion = motion;
    this.source = source; // {values, reference}: names of arrays
    this.canvas = document.createElement("canvas");
    this.canvas.setAttribute("role", "img");
    this.backdrop = document.createElement("canvas");
    const frame = document.createElement("div"); // gives the canvas its size, and takes none from it
    frame.append(this.canvas);
    holder.append(frame);
  }

  /** Values shown: the data's own range, widened to a limit that lies near. */
  range() {
    const { motion, source, spec } = this;
    const tables = [motion.arrays[source.values], motion.arrays[source.reference]].filter((table) => table);
    const ranges = spec.series.map((series) => columnRange(tables, series.column));
    const low = Math.min(...ranges.map((r) => r[0])) * spec.factor;
    const high = Math.max(...ranges.map((r) => r[1])) * spec.factor;
    const near = Math.max(high - low, spec.least) * 0.3;
    const lows = [low, ...spec.series.map((s) => s.lower * spec.factor).filter((v) => v > low - near)];
    const highs = [high, ...spec.series.map((s) => s.upper * spec.factor).filter((v) => v < high + near)];
    const [bottom, top] = [Math.min(...lows), Math.max(...highs)];
    const spare = Math.max(top - bottom, spec.least) * 0.08 + Math.max(0, spec.least - (top - bottom)) / 2;
    return [bottom - spare, top + spare];
  }

  resize() {
    const ratio = Math.min(devicePixelRatio || 1, 3);
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    Object.assign(this, { ratio, width, height });
    for (const canvas of [this.canvas, this.backdrop]) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    this.unit = Math.min(Math.max(Math.min(height / USUAL, width / 320), 1), 1.4);
    const margin = (side) => MARGIN[side] * this.unit;
    this.x = new Scale(0, this.motion.duration || 1, margin("left"), width - margin("right"));
    this.y = new Scale(...this.range(), height - margin("bottom"), margin("top"));
    this.paint();
  }

  pen(canvas) {
    const pen = canvas.getContext("2d");
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    pen.font = 11 * this.unit + FONT;
    return pen;
  }

  paint() {
    const pen = this.pen(this.backdrop);
    const colors = (this.colors = palette());
    pen.clearRect(0, 0, this.width, this.height);
    this.paintStance(pen, colors);
    this.paintAxes(pen, colors);
    pen.save();
    pen.beginPath();
    pen.rect(this.x.from, this.y.to, this.x.to - this.x.from, this.y.from - this.y.to);
    pen.clip();
    for (const series of this.spec.series) this.paintLimits(pen, series, colors);
    for (const series of this.spec.series) this.paintCurve(pen, this.source.reference, series, colors, [4, 3]);
    for (const series of this.spec.series) this.paintCurve(pen, this.source.values, series, colors, []);
    pen.restore();
    pen.fillStyle = colors.ink;
    pen.textAlign = "left";
    pen.fillText(this.spec.title, this.x.from, 13 * this.unit);
  }

  paintStance(pen, colors) {
    for (const [row, side] of ["left", "right"].entries()) {
      pen.fillStyle = colors[side];
      for (const [from, to] of this.motion.stance[side]) {
        const [x0, x1] = [this.x.of(from), this.x.of(to)];
        pen.globalAlpha = 0.07;
        pen.fillRect(x0, this.y.to, x1 - x0, this.y.from - this.y.to);
        pen.globalAlpha = 0.75;
        pen.fillRect(x0, this.y.from + 1.5 + row * 3, x1 - x0, 2);
      }
    }
    pen.globalAlpha = 1;
  }

  paintAxes(pen, colors) {
    pen.strokeStyle = colors.line;
    pen.fillStyle = colors.muted;
    pen.lineWidth = 1;
    pen.textAlign = "right";
    const room = (this.y.from - this.y.to) / (26 * this.unit);
    for (const value of this.y.ticks(Math.max(3, Math.min(room, 5)))) {
      const y = Math.round(this.y.of(value)) + 0.5;
      pen.globalAlpha = value === 0 ? 1 : 0.6;
      pen.beginPath();
      pen.moveTo(this.x.from, y);
      pen.lineTo(this.x.to, y);
      pen.stroke();
      pen.globalAlpha = 1;
      pen.fillText(String(Number(value.toFixed(6))).replace("-", "\u2212"), this.x.from - 5, y + 4 * this.unit);
    }
  }

  paintLimits(pen, series, colors) {
    const { factor } = this.spec;
    const beyond = [
      [this.y.of(series.lower * factor), this.y.from],
      [this.y.to, this.y.of(series.upper * factor)],
    ];
    for (const [top, bottom] of beyond) {
      if (!(bottom - top > 0.5)) continue;
      pen.fillStyle = colors.limit;
      pen.globalAlpha = 0.16;
      pen.fillRect(this.x.from, top, this.x.to - this.x.from, bottom - top);
      pen.globalAlpha = 0.9;
      pen.fillRect(this.x.from, top === this.y.to ? bottom - 1 : top, this.x.to - this.x.from, 1);
    }
    pen.globalAlpha = 1;
  }

  paintCurve(pen, name, series, colors, dash) {
    const table = this.motion.arrays[name];
    if (!table) return;
    const times = this.motion.arrays[`${name}_time`] ? this.motion.arrays[`${name}_time`].data : this.motion.time;
    pen.strokeStyle = colors[series.side] || colors.ink; // of the middle: neither side
    pen.lineWidth = dash.length ? 1.4 : 1.8;
    pen.setLineDash(dash);
    pen.globalAlpha = dash.length ? 0.75 : 1;
    pen.beginPath();
    let down = false; // a canvas would draw across what is not a number
    for (let i = 0; i < times.length; i++) {
      const value = table.data[i * table.width + series.column] * this.spec.factor;
      if (down) pen.lineTo(this.x.of(times[i]), this.y.of(value));
      else pen.moveTo(this.x.of(times[i]), this.y.of(value));
      down = !Number.isNaN(value);
    }
    if (this.motion.periodic) {
      pen.lineTo(this.x.of(this.motion.duration), this.y.of(table.data[series.column] * this.spec.factor));
    }
    pen.stroke();
    pen.setLineDash([]);
    pen.globalAlpha = 1;
  }

  /** Cursor, dots and read-out at time t. */
  draw(t, at) {
    if (!this.x) return;
    const pen = this.pen(this.canvas);
    pen.clearRect(0, 0, this.width, this.height);
    pen.drawImage(this.backdrop, 0, 0, this.width, this.height);
    const x = this.x.of(t);
    pen.strokeStyle = this.colors.ink;
    pen.beginPath();
    pen.moveTo(x, this.y.to);
    pen.lineTo(x, this.y.from);
    pen.stroke();
    const row = this.motion.row(this.source.values, at);
    const said = this.spec.series.map((series, k) => this.mark(pen, x, row[series.column], series, k));
    this.canvas.setAttribute("aria-label", `${this.spec.title}: ${said.join(", ")}`);
  }

  mark(pen, x, raw, series, k) {
    const value = raw * this.spec.factor;
    const text = fixed(value, this.spec.digits) + this.spec.unit;
    pen.fillStyle = this.colors[series.side] || this.colors.ink;
    pen.beginPath();
    pen.arc(x, this.y.of(value), 3.2 * this.unit, 0, 7);
    pen.fill();
    pen.textAlign = "right";
    const last = this.spec.series.length - 1;
    pen.fillText(text, this.x.to - (last - k) * 52 * this.unit, 13 * this.unit);
    return `${series.side} ${text}`;
  }
}
