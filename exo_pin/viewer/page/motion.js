/* Motion: the sampled walk, read between its samples (angles, not poses, are interpolated). */

class Motion {
  constructor(header, arrays) {
    this.arrays = arrays;
    this.time = arrays.time.data;
    this.count = this.time.length;
    this.duration = header.duration;
    this.periodic = header.periodic;
    this.stance = header.stance;
    this.cycles = header.cycles; // {side, spans, estimate}
    this.begins = header.cycles.spans.map(([from]) => from);
    this.borders = [...new Set(header.cycles.spans.flat())]; // heel strikes [s]
  }

  /** Frame pair and fraction at time t: {i, j, a}. A periodic walk closes from its last frame to its first. */
  at(t) {
    const { time, count, periodic, duration } = this;
    if (count < 2) return { i: 0, j: 0, a: 0 };
    const low = Math.max(before(time, t), 0);
    const last = low === count - 1;
    if (last && !periodic) return { i: low, j: low, a: 0 };
    const end = last ? duration : time[low + 1];
    return { i: low, j: last ? 0 : low + 1, a: Math.min((t - time[low]) / (end - time[low]), 1) };
  }

  /** One row of an array, interpolated linearly. */
  row(name, { i, j, a }) {
    const { data, width } = this.arrays[name];
    const out = new Array(width);
    for (let k = 0; k < width; k++) {
      const from = data[i * width + k];
      out[k] = from + (data[j * width + k] - from) * a;
    }
    return out;
  }

  /** A pose [x y z qx qy qz qw]: position linearly, rotation on the great circle. */
  pose(name, { i, j, a }) {
    const row = this.row(name, { i, j, a });
    const { data } = this.arrays[name];
    const turn = new MeshCat.THREE.Quaternion().fromArray(data, i * 7 + 3);
    turn.slerp(new MeshCat.THREE.Quaternion().fromArray(data, j * 7 + 3), a);
    return { position: row.slice(0, 3), turn };
  }

  /** Time of the frame before or after t. */
  neighbour(t, step) {
    const { i } = this.at(t);
    const onFrame = Math.abs(t - this.time[i]) < 1e-9;
    const k = step < 0 && !onFrame ? i : i + step;
    if (this.periodic) return this.time[(k + this.count) % this.count];
    return this.time[Math.min(Math.max(k, 0), this.count - 1)];
  }

  /** The times of an array's rows: its own array of times if it has one, else the walk's. */
  timesOf(name) {
    const own = this.arrays[`${name}_time`];
    return own ? own.data : this.time;
  }

  /** Where in its gait cycle t lies: {share, number, count}; null outside of whole cycles. */
  phase(t) {
    const { spans } = this.cycles;
    const k = before(this.begins, t + 1e-9);
    if (k < 0 || t > spans[k][1]) return null;
    const [from, to] = spans[k];
    return { share: Math.max((t - from) / (to - from), 0), number: k + 1, count: spans.length };
  }

  /** The heel strike before or after t, or the walk's end. */
  strike(t, step) {
    const inside = this.borders.filter((time) => time >= 0 && time <= this.duration);
    const next = step > 0 ? inside.find((time) => time > t + 1e-6) : inside.findLast((time) => time < t - 1e-6);
    return next ?? (step > 0 ? this.duration : 0);
  }

  inStance(side, t) {
    return this.stance[side].some(([from, to]) => from <= t && t < to);
  }
}
