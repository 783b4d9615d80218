/* Backdrop: what of a plot stands still while the cursor moves: stance, cycles, axes, limits, curves. */

const DASH = [4, 3]; // of the reference
const DOTS = [1.4, 2.6]; // of a second walk
const FINE = 2; // more samples than this for a pixel are drawn as their lowest and highest

class Backdrop {
  constructor(plot, colors) {
    const { spec, source, motion, window, showsBand, x, y, unit } = plot;
    Object.assign(this, { spec, source, motion, window, showsBand, x, y, unit, colors });
  }

  paint(pen) {
    const { x, y, colors, spec } = this;
    pen.save();
    pen.beginPath();
    pen.rect(x.from, y.to, x.to - x.from, y.from - y.to + 8 * this.unit);
    pen.clip();
    this.stance(pen);
    pen.restore();
    this.values(pen);
    pen.save();
    pen.beginPath();
    pen.rect(x.from, y.to, x.to - x.from, y.from - y.to);
    pen.clip();
    this.strikes(pen);
    if (this.showsBand) for (const series of spec.series) this.band(pen, series);
    for (const series of spec.series) this.limits(pen, series);
    for (const series of spec.series) this.curve(pen, this.source.compared, series, DOTS);
    for (const series of spec.series) this.curve(pen, this.source.reference, series, DASH);
    for (const series of spec.series) this.curve(pen, this.source.values, series, []);
    pen.restore();
    this.times(pen);
    this.heading(pen);
  }

  /** Title, what a positive value means, and above the axis its unit. */
  heading(pen) {
    const { x, spec, colors, unit } = this;
    const { title, sign } = spec;
    const room = x.to - x.from - spec.series.length * readOutWidth(spec.unit) * unit;
    const direction = title.endsWith(sign) ? " +" : `   ${sign} +`;
    pen.fillStyle = colors.ink;
    pen.textAlign = "left";
    pen.fillText(title, x.from, 13 * unit);
    pen.fillStyle = colors.muted;
    const wide = pen.measureText(title).width;
    if (sign && wide + pen.measureText(direction).width < room) pen.fillText(direction, x.from + wide, 13 * unit);
    pen.textAlign = "right";
    pen.fillText(spec.unit, x.from - 5, 13 * unit);
  }

  stance(pen) {
    for (const [row, side] of ["left", "right"].entries()) {
      pen.fillStyle = this.colors[side];
      for (const [from, to] of this.motion.stance[side]) {
        if (to < this.window.start || from > this.window.end) continue;
        const [x0, x1] = [this.x.of(from), this.x.of(to)];
        pen.globalAlpha = 0.07;
        pen.fillRect(x0, this.y.to, x1 - x0, this.y.from - this.y.to);
        pen.globalAlpha = 0.75;
        pen.fillRect(x0, this.y.from + 1.5 + row * 3, x1 - x0, 2);
      }
    }
    pen.globalAlpha = 1;
  }

  /** The heel strikes between which phase is counted. */
  strikes(pen) {
    if (this.motion.periodic) return;
    pen.strokeStyle = this.colors.muted;
    pen.globalAlpha = 0.55;
    pen.setLineDash([1, 3]);
    for (const t of this.motion.borders) {
      if (t >= this.window.start && t <= this.window.end) this.rule(pen, Math.round(this.x.of(t)) + 0.5);
    }
    pen.setLineDash([]);
    pen.globalAlpha = 1;
  }

  rule(pen, x) {
    pen.beginPath();
    pen.moveTo(x, this.y.to);
    pen.lineTo(x, this.y.from);
    pen.stroke();
  }

  values(pen) {
    const { x, y, colors, unit } = this;
    pen.strokeStyle = colors.line;
    pen.fillStyle = colors.muted;
    pen.lineWidth = 1;
    pen.textAlign = "right";
    const room = (y.from - y.to) / (26 * unit);
    for (const value of y.ticks(Math.max(3, Math.min(room, 5)), 3)) {
      const at = Math.round(y.of(value)) + 0.5;
      pen.globalAlpha = value === 0 ? 1 : 0.6;
      pen.beginPath();
      pen.moveTo(x.from, at);
      pen.lineTo(x.to, at);
      pen.stroke();
      pen.globalAlpha = 1;
      pen.fillText(plain(value), x.from - 5, at + 4 * unit);
    }
  }

  /** Percent of a cycle that repeats, seconds of a recording. */
  times(pen) {
    const { x, y, unit, motion } = this;
    const axis = motion.periodic ? new Scale(0, 100, x.from, x.to) : x;
    const name = motion.periodic ? " %" : " s";
    const ticks = axis.ticks(Math.max(2, Math.min((x.to - x.from) / (42 * unit), 10)));
    pen.font = 9.5 * unit + FONT;
    pen.fillStyle = this.colors.muted;
    ticks.forEach((value, k) => {
      const text = plain(value) + (k === ticks.length - 1 ? name : "");
      const half = pen.measureText(text).width / 2;
      pen.textAlign = "left";
      const at = Math.min(Math.max(axis.of(value) - half, x.from - 4), x.to + 8 * unit - 2 * half);
      pen.fillText(text, at, y.from + 17 * unit);
    });
    pen.font = 11 * unit + FONT;
  }

  limits(pen, series) {
    const { x, y, spec } = this;
    const beyond = [
      [y.of(series.lower * spec.factor), y.from],
      [y.to, y.of(series.upper * spec.factor)],
    ];
    for (const [top, bottom] of beyond) {
      if (!(bottom - top > 0.5)) continue;
      pen.fillStyle = this.colors.limit;
      pen.globalAlpha = 0.16;
      pen.fillRect(x.from, top, x.to - x.from, bottom - top);
      pen.globalAlpha = 0.9;
      pen.fillRect(x.from, top === y.to ? bottom - 1 : top, x.to - x.from, 1);
    }
    pen.globalAlpha = 1;
  }

  /** The normal band of a series, wherever its phase is known: one area for each unbroken stretch. */
  band(pen, { side, column }) {
    const [low, high] = [this.source.low, this.source.high].map((name) => this.motion.arrays[name]);
    if (!low) return;
    const { time, periodic, duration } = this.motion;
    const count = time.length + (periodic ? 1 : 0); // a cycle closes
    const value = ({ data, width }, i) => data[(i % time.length) * width + column] * this.spec.factor;
    const x = (i) => this.x.of(i < time.length ? time[i] : duration);
    pen.fillStyle = this.colors[side] || this.colors.ink;
    pen.globalAlpha = 0.17;
    for (let from = 0; from < count; from++) {
      let to = from;
      while (to < count && !Number.isNaN(value(low, to))) to++;
      if (to - from < 2) continue;
      pen.beginPath();
      for (let i = from; i < to; i++) pen.lineTo(x(i), this.y.of(value(high, i)));
      for (let i = to - 1; i >= from; i--) pen.lineTo(x(i), this.y.of(value(low, i)));
      pen.fill();
      from = to;
    }
    pen.globalAlpha = 1;
  }

  curve(pen, name, series, dash) {
    const table = this.motion.arrays[name];
    if (!table) return;
    pen.strokeStyle = this.colors[series.side] || this.colors.ink; // of the middle: neither side
    pen.lineWidth = dash.length ? 1.4 : 1.8;
    pen.setLineDash(dash);
    pen.globalAlpha = dash.length ? 0.75 : 1;
    this.trace(pen, this.motion.timesOf(name), table, series.column);
    pen.setLineDash([]);
    pen.globalAlpha = 1;
  }

  trace(pen, times, { data, width }, column) {
    const { factor } = this.spec;
    const first = Math.max(before(times, this.window.start), 0);
    const last = Math.min(before(times, this.window.end) + 2, times.length);
    const pixels = Math.max(this.x.to - this.x.from, 1);
    const coarse = (last - first) / pixels > FINE;
    const points = coarse ? extremes(data, width, column, first, last, pixels) : null;
    let down = false; // a canvas would draw across what is not a number
    pen.beginPath();
    const point = (t, value) => {
      if (down) pen.lineTo(this.x.of(t), this.y.of(value * factor));
      else pen.moveTo(this.x.of(t), this.y.of(value * factor));
      down = !Number.isNaN(value);
    };
    if (points) for (const i of points) point(times[i], data[i * width + column]);
    else for (let i = first; i < last; i++) point(times[i], data[i * width + column]);
    if (this.motion.periodic) point(this.motion.duration, data[column]);
    pen.stroke();
  }
}

/** Rows with the lowest and the highest value of every stretch as wide as a pixel, in order. */
function extremes(data, width, column, first, last, pixels) {
  const rows = [];
  const step = (last - first) / pixels;
  for (let from = first; from < last; from += step) {
    const start = Math.round(from);
    let [low, high] = [start, start];
    for (let i = start; i < Math.min(Math.round(from + step), last); i++) {
      if (data[i * width + column] < data[low * width + column]) low = i;
      if (data[i * width + column] > data[high * width + column]) high = i;
    }
    rows.push(Math.min(low, high), Math.max(low, high));
  }
  return rows;
}
