// Numbers in engineering notation.

const PREFIXES = [
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "\u00b5"],
  [1e-9, "n"],
];
const PREFIXED = new Set(["N", "J", "W", "Pa", "N m", "N\u00b7m", "Hz", "V"]);
const SMALL_ONLY = new Set(["m", "s", "m/s", "rad"]); // no kiloseconds

/** Return {scale, unit}: the divisor of numbers up to `largest`, and their unit then. */
export function scaled(given, largest) {
  const unit = given === "1" ? "" : given;
  const size = Math.abs(largest);
  if (!(size > 0) || !Number.isFinite(size)) return { scale: 1, unit };
  const prefixed = PREFIXED.has(unit);
  if (prefixed || SMALL_ONLY.has(unit)) {
    const [scale, prefix] =
      PREFIXES.find(([factor]) => size >= factor * 0.9995 && (prefixed || factor <= 1)) ?? PREFIXES.at(-1);
    return { scale, unit: prefix + unit };
  }
  if (size >= 1e-3 && size < 1e5) return { scale: 1, unit };
  const exponent = 3 * Math.floor(Math.log10(size) / 3);
  return { scale: 10 ** exponent, unit: `\u00d710${superscript(exponent)}${unit ? " " + unit : ""}` };
}

function superscript(number) {
  return [...String(number)]
    .map((c) => (c === "-" ? "\u207b" : "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079"[c]))
    .join("");
}

/** Return a number with four digits, or fewer if its last one would lie below `step`; a true minus sign. */
export function number(value, digits = 4, step = 0) {
  if (!Number.isFinite(value)) return "\u2013";
  if (value === 0) return "0";
  const first = Math.floor(Math.log10(Math.abs(value)));
  const last = Math.max(first - digits + 1, step > 0 ? Math.ceil(Math.log10(step)) : -Infinity);
  const rounded = Math.round(value / 10 ** last) * 10 ** last;
  if (rounded === 0) return "0";
  const text =
    Math.abs(rounded) >= 1e6 || Math.abs(rounded) < 1e-4
      ? rounded.toExponential(Math.max(0, first - last)).replace("e+", "e")
      : rounded.toFixed(Math.min(20, Math.max(0, -last)));
  return text.replace(/-/g, "\u2212");
}

/** Return a value with its unit: "201.3 kN". `step`: of the rounding of the page. */
export function withUnit(value, unit, step = 0) {
  if (!Number.isFinite(value)) return "no value";
  const { scale, unit: shown } = scaled(unit, value);
  return `${number(value / scale, 4, step / scale)} ${shown}`.trim();
}

/** Return round numbers (1, 2, 5 times a power of ten) between low and high, about `count` of them. */
export function ticks(low, high, count) {
  if (!(high > low)) return [low];
  const step = niceStep((high - low) / count);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) => (first + i) * step);
}

/** Return the smallest of 1, 2, 5 times a power of ten that is not below `least`. */
export function niceStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * ([1, 2, 5, 10].find((factor) => factor * power >= least * (1 - 1e-9)) ?? 10);
}

/** Return a number of an axis whose ticks are `step` apart. */
export function tick(value, step) {
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const text = Math.abs(value) < step * 1e-6 ? "0" : value.toFixed(Math.min(decimals, 12));
  return text.replace("-", "\u2212");
}
