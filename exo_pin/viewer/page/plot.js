/* Plot: one joint's curves, left and right. The curves are painted once per size and window; per frame only
   the cursor is. */

const MARGIN = { left: 38, right: 10, top: 22, bottom: 22 };
const FONT = "px system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";
const USUAL = 105; // height of a plot [px] at which text is 11 px; taller plots have larger text

function palette() {
  const css = getComputedStyle(document.documentElement);
  const names = ["left", "right", "ink", "muted", "line", "limit", "surface"];
  return Object.fromEntries(names.map((name) => [name, css.getPropertyValue(`--${name}`).trim()]));
}

/** Width of a number with its unit [px at unit 1]. */
function readOutWidth(unit) {
  return 46 + 6 * withUnit("", unit).length;
}

class Plot {
  /** source: {values, reference, compared}, names of arrays; window: the stretch of time that all plots show. */
  constructor(spec, motion, source, window, holder) {
    Object.assign(this, { spec, motion, source, window });
    this.canvas = document.createElement("canvas");
    this.canvas.setAttribute("role", "img");
    this.backdrop = document.createElement("canvas");
    const frame = document.createElement("div"); // gives the canvas its size, and takes none from it
    frame.append(this.canvas);
    holder.append(frame);
    this.span = this.range();
  }

  /** Values shown: the data's own range, widened to a limit that lies near. */
  range() {
    const { motion, source, spec } = this;
    const names = [source.values, source.reference, source.compared, source.low, source.high];
    const tables = names.map((name) => motion.arrays[name]).filter((table) => table);
    const ranges = spec.series.map((series) => columnRange(tables, series.column));
    const low = Math.min(...ranges.map((r) => r[0])) * spec.factor;
    const high = Math.max(...ranges.map((r) => r[1])) * spec.factor;
    const near = Math.max(high - low, spec.least) * 0.15;
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
    Object.assign(this, { ratio, width, height, colors: palette() });
    for (const canvas of [this.canvas, this.backdrop]) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    this.unit = Math.min(Math.max(Math.min(height / USUAL, width / 320), 1), 1.7);
    this.paint();
  }

  pen(canvas) {
    const pen = canvas.getContext("2d");
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    pen.font = 11 * this.unit + FONT;
    return pen;
  }

  /** Paints the curves; needed again when the window has moved. */
  paint() {
    if (!this.width) return;
    const margin = (side) => MARGIN[side] * this.unit;
    const { start, end } = this.window;
    this.x = new Scale(start, end, margin("left"), this.width - margin("right"));
    this.y = new Scale(...this.span, this.height - margin("bottom"), margin("top"));
    const pen = this.pen(this.backdrop);
    pen.clearRect(0, 0, this.width, this.height);
    new Backdrop(this, this.colors).paint(pen);
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
    const texts = this.spec.series.map((series, k) => this.mark(pen, x, row[series.column], series, k));
    this.canvas.setAttribute("aria-label", `${this.spec.title}: ${texts.join(", ")}`);
  }

  mark(pen, x, raw, series, k) {
    const value = raw * this.spec.factor;
    const text = Number.isNaN(value) ? "\u2013" : withUnit(fixed(value, this.spec.digits), this.spec.unit);
    pen.fillStyle = this.colors[series.side] || this.colors.ink;
    if (!Number.isNaN(value)) {
      pen.beginPath();
      pen.arc(x, this.y.of(value), 3.2 * this.unit, 0, 7);
      pen.fill();
    }
    pen.textAlign = "right";
    const last = this.spec.series.length - 1;
    const slot = readOutWidth(this.spec.unit);
    pen.fillText(text, this.x.to - (last - k) * slot * this.unit, 13 * this.unit);
    return `${series.side} ${text}`;
  }
}
