/* Bundle: the binary form of a scene, which both transports carry.
   gzip of chunks [u32 length, bytes]: a JSON header, the meshcat commands, then the arrays it names. */

const NONE = -32768; // of a rounded curve: not a number

async function inflate(bytes) {
  if (!window.DecompressionStream) throw new Error("This browser is too old: it has no DecompressionStream.");
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function fromBase64(text) {
  return Uint8Array.from(atob(text.trim()), (c) => c.charCodeAt(0));
}

function* chunks(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  for (let at = 0; at < bytes.length; ) {
    const size = view.getUint32(at, true);
    yield bytes.slice(at + 4, at + 4 + size); // a copy is aligned, as typed arrays demand
    at += 4 + size;
  }
}

/** {header, commands: [Uint8Array], arrays: {name: {data, width}}} */
async function readBundle(zipped) {
  const parts = [...chunks(await inflate(zipped))];
  const header = JSON.parse(new TextDecoder().decode(parts[0]));
  const commands = parts.slice(1, 1 + header.commands);
  const arrays = {};
  for (const spec of header.arrays) {
    arrays[spec.name] = { data: numbers(parts[1 + header.commands + spec.chunk], spec), width: spec.width };
  }
  return { header, commands, arrays };
}

/** The rows of an array as exo_pin/viewer/page/packing.py packs them. */
function numbers(bytes, { type, width, middle, step }) {
  if (type === "f8") return new Float64Array(bytes.buffer);
  if (type === "f4") return byRows(new Float32Array(summed(bytes, width, Uint32Array).buffer), width);
  const steps = byRows(new Int16Array(summed(bytes, width, Uint16Array).buffer), width);
  return Float32Array.from(steps, (k, i) => (k === NONE ? NaN : middle[i % width] + k * step[i % width]));
}

/** Columns of numbers from their differences, of which the first bytes come first. */
function summed(bytes, width, Kind) {
  const count = bytes.length / Kind.BYTES_PER_ELEMENT;
  const out = new Kind(count);
  for (let k = 0; k < bytes.length; k++) out[k % count] |= bytes[k] << (8 * Math.floor(k / count));
  for (let k = 1; k < count; k++) if (k % (count / width)) out[k] += out[k - 1];
  return out;
}

function byRows(columns, width) {
  const out = new columns.constructor(columns.length);
  const rows = columns.length / width;
  for (let k = 0; k < columns.length; k++) out[(k % rows) * width + Math.floor(k / rows)] = columns[k];
  return out;
}
