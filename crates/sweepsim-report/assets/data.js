// The embedded data: `head` describes arrays, `arrays` holds them in base64, each compressed by itself (zlib).
// An array of n-byte numbers is stored as differences from the number before, all low bytes first, then all second bytes, and so on.

/** Bytes from base64. */
function fromBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text.trim());
  const plain = atob(text.trim());
  const bytes = new Uint8Array(plain.length);
  for (let k = 0; k < plain.length; k++) bytes[k] = plain.charCodeAt(k);
  return bytes;
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

const ARRAY_TYPES = { U8: Uint8Array, I8: Int8Array, U16: Uint16Array, I16: Int16Array, U32: Uint32Array };

/** The numbers of one array. */
function joined(kind, count, plain) {
  if (kind === "U8") return plain;
  const numbers = new ARRAY_TYPES[kind](count);
  const width = numbers.BYTES_PER_ELEMENT;
  let before = 0;
  for (let k = 0; k < count; k++) {
    let step = 0;
    for (let plane = 0; plane < width; plane++) step |= plain[plane * count + k] << (8 * plane);
    before = (before + step) | 0;
    numbers[k] = before; // wraps to the type's width
  }
  return numbers;
}

/** The description, with all arrays by name in `data`. */
async function readEmbedded() {
  const text = (id) => document.getElementById(id).textContent;
  const head = JSON.parse(text("head"));
  const bytes = fromBase64(text("arrays"));
  head.data = {};
  let at = 0;
  const waiting = head.arrays.map(async (entry) => {
    const own = bytes.subarray(at, (at += entry.bytes));
    head.data[entry.name] = joined(entry.kind, entry.count, await inflated(own));
  });
  await Promise.all(waiting);
  return head;
}
