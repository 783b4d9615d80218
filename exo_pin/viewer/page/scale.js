/* Scale: from values to pixels, with ticks at round numbers. */

/** Round step that cuts a span into about `parts` pieces. */
function roundStep(span, parts) {
  const raw = span / parts;
  const power = 10 ** Math.floor(Math.log10(raw));
  return [1, 2, 2.5, 5, 10].map((k) => k * power).find((step) => step >= raw * 0.999);
}

/** A number for people: so many decimals, a true minus, and none before a zero. */
function fixed(value, digits) {
  const text = value.toFixed(digits);
  return (Number(text) === 0 ? text.replace("-", "") : text).replace("-", "\u2212");
}

/** A number's text with its unit; degrees stand close to it. */
function withUnit(text, unit) {
  return unit.startsWith("\u00b0") ? text + unit : `${text} ${unit}`;
}

/** A tick's number, without the dust of binary fractions. */
function plain(value) {
  return String(Number(value.toFixed(6))).replace("-", "\u2212");
}

/** Index of the last of rising times that is not after t; -1 if all are. */
function before(times, t) {
  let low = -1;
  let high = times.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle;
  }
  return low;
}

/** Lowest and highest value of one column, widened a little and never flat. */
function columnRange(arrays, column) {
  let low = Infinity;
  let high = -Infinity;
  for (const { data, width } of arrays) {
    for (let k = column; k < data.length; k += width) {
      if (!Number.isFinite(data[k])) continue;
      low = Math.min(low, data[k]);
      high = Math.max(high, data[k]);
    }
  }
  return low <= high ? [low, high] : [-1, 1];
}

class Scale {
  constructor(low, high, from, to) {
    this.low = low;
    this.high = high;
    this.from = from;
    this.to = to;
  }

  /** Pixel of a value. */
  of(value) {
    return this.from + ((value - this.low) / (this.high - this.low)) * (this.to - this.from);
  }

  /** Value at a pixel, kept inside the scale. */
  at(pixel) {
    const part = (pixel - this.from) / (this.to - this.from);
    return this.low + Math.min(Math.max(part, 0), 1) * (this.high - this.low);
  }

  /** Round values, as many as fit in about `parts` steps, and at least so many. */
  ticks(parts, least = 0) {
    for (let finer = parts; ; finer *= 1.1) {
      const found = this.multiples(roundStep(this.high - this.low, finer));
      if (found.length >= least) return found;
    }
  }

  multiples(step) {
    const out = [];
    for (let v = Math.ceil(this.low / step - 1e-9) * step; v <= this.high + step * 1e-9; v += step) {
      out.push(Math.abs(v) < step * 1e-9 ? 0 : v);
    }
    return out;
  }
}
