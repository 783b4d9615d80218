/* Clock: the playback's time, advanced by the wall clock. */

class Clock {
  constructor(duration) {
    this.duration = duration; // [s]
    this.time = 0; // [s]
    this.speed = 1;
    this.loop = true;
    this.playing = false;
    this.last = null; // wall clock of the last tick [ms]
  }

  play(on = true) {
    if (on && !this.loop && this.time >= this.duration) this.time = 0;
    this.playing = on;
    this.last = performance.now();
  }

  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.duration);
  }

  /** Advances by the wall clock; a tab that slept does not jump. */
  tick(now) {
    const elapsed = this.last === null ? 0 : Math.min(Math.max(now - this.last, 0) / 1000, 1);
    this.last = now;
    if (!this.playing || this.duration <= 0) return;
    const next = this.time + elapsed * this.speed;
    if (next < this.duration) this.time = next;
    else if (this.loop) this.time = next % this.duration;
    else {
      this.time = this.duration;
      this.playing = false;
    }
  }
}
