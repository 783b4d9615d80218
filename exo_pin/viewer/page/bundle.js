/* Bundle: the binary form of a scene, which both transports carry.
   gzip of chunks [u32 length, bytes]: a JSON header, the meshcat commands, then the arrays it names. */

const ARRAYS = { f4: Float32Array, f8: Float64Array };

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
  header.arrays.forEach((spec, k) => {
    const bytes = parts[1 + header.commands + k];
    arrays[spec.name] = { data: new ARRAYS[spec.type](bytes.buffer), width: spec.width };
  });
  return { header, commands, arrays };
}
