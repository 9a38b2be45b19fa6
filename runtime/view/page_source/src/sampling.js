// Values of arrays over time: exact at frames, linear between them.

/** Return {i, j, w}: the frames around a time and the weight of the second.
 *  Constant before the first and after the last. */
export function sampleAt(times, time, period = null) {
  const last = times.length - 1;
  if (last === 0) return { i: 0, j: 0, w: 0 };
  let t = time;
  if (period) {
    t = times[0] + ((((time - times[0]) % period) + period) % period);
    if (t > times[last]) return { i: last, j: 0, w: (t - times[last]) / (times[0] + period - times[last]) };
  }
  if (t <= times[0]) return { i: 0, j: 0, w: 0 };
  if (t >= times[last]) return { i: last, j: last, w: 0 };
  let low = 0;
  let high = last;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle;
  }
  return { i: low, j: high, w: (t - times[low]) / (times[high] - times[low]) };
}

/** Return whether a time lies outside of the frames. */
export function isOutside(times, time, period = null) {
  const margin = 1e-6 * (times.at(-1) - times[0]);
  return !period && times.length > 1 && (time < times[0] - margin || time > times.at(-1) + margin);
}

/** Return the time of a sample: that of its frames, between the first and the last. */
export function timeOf(times, { i, j, w }) {
  return w === 0 ? times[i] : times[i] + w * (times[j] - times[i]);
}

/** Return the value at offset `k` of a frame of an array; an array of one frame is constant. */
export function valueAt(array, sample, k) {
  const stride = array.values.length / array.shape[0];
  if (array.shape[0] === 1) return array.values[k];
  const first = array.values[sample.i * stride + k];
  return sample.w === 0 ? first : first + sample.w * (array.values[sample.j * stride + k] - first);
}

/** Return the frame of an array at a sample, written to `out`. */
export function frameAt(array, sample, out) {
  const { values, shape } = array;
  const stride = values.length / shape[0];
  const i = shape[0] === 1 ? 0 : sample.i * stride;
  if (shape[0] === 1 || sample.w === 0) {
    for (let k = 0; k < stride; k++) out[k] = values[i + k];
    return out;
  }
  const j = sample.j * stride;
  for (let k = 0; k < stride; k++) out[k] = values[i + k] + sample.w * (values[j + k] - values[i + k]);
  return out;
}

/** Return a point at a sample, its displacement from the reference drawn `factor` times as large, written to `out`. */
export function pointAt(position, reference, sample, factor, out) {
  for (let k = 0; k < 3; k++) {
    const at = valueAt(position, sample, k);
    if (factor === 1) {
      out[k] = at;
    } else {
      const from = valueAt(reference, sample, k);
      out[k] = from + factor * (at - from);
    }
  }
  return out;
}
