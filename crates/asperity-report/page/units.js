// Numbers with SI prefixes, ticks at round numbers.

const PREFIXES = { "-4": "p", "-3": "n", "-2": "µ", "-1": "m", 0: "", 1: "k", 2: "M", 3: "G" };
const PREFIXED = {
  m: [-4, 0], s: [-3, 0], "m/s": [-3, 1], Pa: [-1, 3], Hz: [-2, 3],
  N: [-3, 2], "N m": [-3, 2], "N/m": [-3, 3], "N/m2": [-1, 3], J: [-4, 1], "J/m": [-4, 1], W: [-4, 1], "W/m": [-4, 1],
};
// Long times: from so many seconds on, seconds in the unit, its name.
const LONG = [[3 * 31557600, 31557600, "a"], [2 * 86400, 86400, "d"], [3 * 3600, 3600, "h"]];
const superscript = (n) => String(n).replace(/[-0-9]/g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]));

/** The unit to show numbers in whose largest magnitude is `largest` in the SI unit `unit`. */
function shown(unit, largest) {
  if (unit === "s" && state.time_unit) return state.time_unit;
  const long = unit === "s" && isFinite(largest) && LONG.find(([from]) => largest >= from);
  if (long) return { factor: 1 / long[1], text: long[2] };
  const inverse = unit.startsWith("1/");
  const base = inverse ? unit.slice(2) : unit;
  // The prefix of a quotient is that of its first unit, to the first power.
  const [, letters, digits] = base.includes("/") ? [base, base, ""] : /^(.*?)([0-9]*)$/.exec(base);
  const range = PREFIXED[letters];
  if (!range) return { factor: 1, text: unit === "1" ? "" : unit };
  const power = digits ? Number(digits) : 1;
  const exponent = inverse ? -power : power;
  let prefix = 0;
  if (largest > 0 && isFinite(largest)) {
    // Areas in 0.01 to 10^4, volumes in 0.001 to 10^6.
    const few = power === 2 || power === 3 ? (inverse ? -power : power) : 0;
    const steps = Math.floor((Math.log10(largest) + 2.17e-5 + few) / (3 * power));
    prefix = inverse ? -steps : steps;
  }
  prefix = Math.min(Math.max(prefix, range[0]), range[1]);
  const text = (inverse ? "1/" : "") + PREFIXES[prefix] + letters.replace("m2", "m²") + (power === 1 ? "" : superscript(power));
  return { factor: Math.pow(10, -3 * prefix * exponent), text };
}

/** A number with four digits, or all those before the point. */
function digits(value) {
  if (!isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(3).replace("-", "−");
  return String(size >= 1000 ? Math.round(value) : Number(value.toPrecision(4))).replace("-", "−");
}

/** A number rounded where the fourth digit of `of` is. */
function rounded(value, of) {
  const digit = 3 - Math.floor(Math.log10(Math.abs(of) || 1));
  return Number(value.toFixed(Math.min(Math.max(digit, 0), 20))) + 0; // no negative zero
}

/** A quantity with four digits, its prefix and its unit. */
function words(value, unit) {
  if (!isFinite(value)) return "undefined";
  const { factor, text } = shown(unit, Math.abs(value));
  return digits(value * factor) + (text ? " " + text : "");
}

/** Ticks [{value, text}] between two ends, already in the unit shown. */
function ticks(low, high, wanted, log) {
  const list = [];
  if (log) {
    const first = Math.floor(Math.log10(low) + 1e-9), last = Math.ceil(Math.log10(high) - 1e-9);
    const span = Math.log10(high / low);
    const every = Math.max(1, Math.ceil(span / wanted));
    for (let n = first; n <= last; n++) {
      for (const digit of span < 2 ? [1, 2, 5] : [1]) {
        const value = digit * Math.pow(10, n);
        if (value < low * (1 - 1e-9) || value > high * (1 + 1e-9) || ((n % every) + every) % every) continue;
        const plain = n >= -2 && n <= 3;
        const text = plain ? String(Number(value.toPrecision(3))) : (digit > 1 ? digit + "×" : "") + "10" + superscript(n);
        list.push({ value, text });
      }
    }
    if (list.length >= 2) return list;
    list.length = 0;
  }
  const rough = (high - low) / Math.max(wanted, 1);
  const tens = Math.pow(10, Math.floor(Math.log10(rough)));
  const step = [1, 2, 5, 10].find((k) => k * tens >= rough * (1 - 1e-9)) * tens;
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  for (let n = Math.ceil(low / step - 1e-9); n <= high / step + 1e-9 && list.length < 50; n++) {
    const value = n * step;
    if (log && value <= 0) continue;
    const size = Math.abs(value), is_plain = size < 1e6 && decimals <= 6;
    // All ticks have the digits that tell them apart.
    const own = value === 0 ? 0 : Math.max(1, Math.round(Math.floor(Math.log10(size) + 1e-9) + decimals));
    const text = is_plain ? value.toFixed(decimals) : size >= 1e6 ? value.toExponential(1) : value === 0 ? "0" : value.toExponential(own);
    list.push({ value, text: text.replace(/^-(?=0(\.0*)?$)/, "").replace("-", "−") });
  }
  return list;
}

/** The unit of an axis; decades of time are those of the second. */
function shownOnAxis(unit, largest, log) {
  return shown(unit, unit === "s" && log ? Math.min(largest, 1e4) : largest);
}
