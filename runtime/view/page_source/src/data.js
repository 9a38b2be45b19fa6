// The content of the page: header and arrays, in the format of runtime/view/page_arrays.py.

const MISSING = -(2 ** 31); // a missing number

/** Return the header of the page with arrays ({shape, step, values}) in place of their numbers. */
export async function read(document) {
  const header = JSON.parse(document.getElementById("header").textContent);
  const packed = Uint8Array.from(atob(document.getElementById("arrays").textContent), (c) => c.charCodeAt(0));
  const arrays = decode(await inflate(packed), header.arrays);
  for (const clip of header.clips) resolve(clip, arrays);
  return header;
}

async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function decode(bytes, descriptions) {
  let start = 0;
  return descriptions.map((description) => {
    const count = description.shape.reduce((product, length) => product * length, 1);
    const integers = new Int32Array(count);
    for (let i = 0; i < count; i++) {
      const coded =
        bytes[start + i] |
        (bytes[start + count + i] << 8) |
        (bytes[start + 2 * count + i] << 16) |
        (bytes[start + 3 * count + i] << 24);
      integers[i] = (coded >>> 1) ^ -(coded & 1);
    }
    start += 4 * count;
    for (const axis of [...description.differences].reverse()) sum(integers, description.shape, axis);
    return { shape: description.shape, step: description.step ?? 0, values: numbers(integers, description) };
  });
}

/** Cumulative sums along an axis; an Int32Array overflows modulo 2^32. */
function sum(integers, shape, axis) {
  const stride = shape.slice(axis + 1).reduce((product, length) => product * length, 1);
  const block = stride * shape[axis];
  for (let first = 0; first < integers.length; first += block) {
    for (let i = first + stride; i < first + block; i++) integers[i] += integers[i - stride];
  }
}

function numbers(integers, { kind, shape, step }) {
  if (kind === "integer") return integers;
  if (kind === "float") return new Float32Array(integers.buffer);
  const values = shape.length === 1 ? new Float64Array(integers.length) : new Float32Array(integers.length);
  for (let i = 0; i < integers.length; i++) values[i] = integers[i] === MISSING ? NaN : integers[i] * step;
  return values;
}

function resolve(clip, arrays) {
  const take = (object, ...keys) =>
    keys.forEach((key) => {
      object[key] = object[key] === null ? null : arrays[object[key]];
    });
  take(clip, "time");
  clip.time = clip.time.values;
  for (const cable of clip.cables) {
    take(cable, "s", "position", "reference", "section_y", "material_s");
    cable.quantities.forEach((quantity) => take(quantity, "values"));
  }
  for (const body of clip.bodies) {
    take(body, "position", "orientation", "reference");
    body.quantities.forEach((quantity) => take(quantity, "values"));
    if (body.shape.kind === "mesh") take(body.shape, "vertices", "triangles");
  }
  for (const mark of clip.marks) take(mark, "position", "reference");
  for (const segment of clip.segments) {
    take(segment, "start", "end");
    segment.references = segment.references.map((number) => arrays[number]);
  }
  for (const curve of clip.curves) {
    take(curve, "time", "values");
    curve.time = curve.time.values;
  }
}
