/* Window: the interval of time that the plots show. It follows the cursor through a long recording. */

const LONG = 10; // [s]: a longer recording is at first shown in part
const AT_FIRST = 5; // [s] of it
const EDGE = 0.1; // share of the window that stays free before and behind the cursor

class TimeWindow {
  /** `calm`: the window turns over like a page instead of sliding. */
  constructor(duration, calm) {
    this.duration = duration || 1;
    this.calm = calm;
    this.least = Math.min(0.2, this.duration); // [s]
    this.start = 0;
    this.span = duration > LONG ? AT_FIRST : this.duration;
  }

  get end() {
    return this.start + this.span;
  }

  get whole() {
    return this.span >= this.duration;
  }

  /** Widens by a factor about a time (below 1: narrows). */
  zoom(factor, about) {
    const share = Math.min(Math.max((about - this.start) / this.span, 0), 1);
    this.span = Math.min(Math.max(this.span * factor, this.least), this.duration);
    this.place(about - share * this.span);
  }

  /** The whole recording, or, if it is shown already, a part of it around a time. */
  toggle(about) {
    this.span = this.whole ? Math.min(AT_FIRST, this.duration / 2) : this.duration;
    this.place(about - this.span / 2);
  }

  place(start) {
    this.start = Math.min(Math.max(start, 0), this.duration - this.span);
  }

  /** Moves so that a time lies inside; true if it moved. */
  follow(t) {
    const before = this.start;
    const edge = EDGE * this.span;
    const [low, high] = [this.start + edge, this.end - edge];
    if (t < this.start || t > this.end) this.place(t - this.span / 2);
    else if (t > high) this.place(this.calm ? t - edge : t - this.span + edge);
    else if (t < low) this.place(this.calm ? t - this.span + edge : t - edge);
    return this.start !== before;
  }
}
