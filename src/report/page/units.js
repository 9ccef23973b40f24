// Values with the prefix in which they read best.
const kSuperscripts = '⁰¹²³⁴⁵⁶⁷⁸⁹';
const powerOfTen = (exponent) =>
  '10' + [...String(exponent)].map((letter) => (letter === '-' ? '⁻' : kSuperscripts[Number(letter)])).join('');

// A value times `factor` is in `text`, which may be empty.
function readingUnit(unit, value) {
  const size = Math.abs(value);
  if (!(size > 0) || !Number.isFinite(size)) return {text: unit, factor: 1};
  const steps = study.units[unit];
  const [, text, factor] = steps.findLast(([least]) => size >= least) || steps[0];
  return {text, factor};
}

// What is rounded to so many letters of an exact number: of two that are as near the one whose last
// digit is even, where JavaScript takes the greater.
function evenly(rounded, exact, letters) {
  const kept = exact.slice(0, letters);
  return /^\.?50*$/.test(exact.slice(letters)) && /[02468]$/.test(kept) ? kept : rounded;
}

// A number with three digits, the same ones as format_number in C++ gives it.
const kExact = 100;  // decimals: a number that lies between two has no more
const isPlain = (exponent) => exponent >= -4 && exponent < 7;
function digits(value, count = 3) {
  if (value === null || value === undefined) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  const sign = value < 0 ? '-' : '';
  // The exponent after rounding: 9.9996 with four digits is 10.00.
  const [mantissa, exponent] = size.toExponential(count - 1).split('e');
  if (!isPlain(Number(exponent))) {
    return `${sign}${evenly(mantissa, size.toExponential(kExact).split('e')[0], mantissa.length)} × ${powerOfTen(Number(exponent))}`;
  }
  const decimals = Math.max(0, count - 1 - Number(exponent));
  const exact = size.toFixed(kExact);
  return sign + evenly(size.toFixed(decimals), exact, exact.length - kExact + (decimals > 0 ? decimals : -1));
}

const numberIn = (value, scale) => (value === null || value === undefined ? '–' : digits(value * scale.factor));
const followedBy = (text, unit) => (unit ? `${text} ${unit}` : text);
// "Mean ATE RMSE", but not "Mean mean position error".
const meanTitle = (name) => (metricTitle(name).startsWith('mean ') ? metricTitle(name) : `mean ${metricTitle(name)}`);
const titled = (title, unit) => (unit ? `${title} (${unit})` : title);

// "17.4 mm"
function quantity(value, unit) {
  const scale = readingUnit(unit, value);
  return followedBy(numberIn(value, scale), scale.text);
}

const greatestOf = (values) => values.reduce((most, value) => Math.max(most, Math.abs(value || 0)), 0);

// The unit of a row or a column of values, in which the typical one reads best; null where another
// one would be a power of ten in it, and each has a unit of its own.
function sharedUnit(unit, values, typical = greatestOf(values)) {
  const scale = readingUnit(unit, typical);
  const isLong = (value) => value !== 0 && !isPlain(Number((value * scale.factor).toExponential(2).split('e')[1]));
  return values.some(isLong) ? null : scale;
}

const unitWithInterval = (one, metric) => readingUnit(unitOf(metric), greatestOf([one.mean, one.low, one.high]));

// A unit is understood of the ends of an interval, a power of ten is not.
const isPower = (text) => text.startsWith('×');
const rangeOf = (one, scale) => `[${numberIn(one.low, scale)}, ${numberIn(one.high, scale)}]`;

// "17.4 mm [16.1, 18.4]" of a mean of a metric, or "(1.70 [0.48, 9.17]) × 10⁶".
function withInterval(one, metric) {
  const scale = unitWithInterval(one, metric);
  const mean = numberIn(one.mean, scale);
  if (one.low === undefined) return followedBy(mean, scale.text);
  return isPower(scale.text) ? `(${mean} ${rangeOf(one, scale)}) ${scale.text}` : `${followedBy(mean, scale.text)} ${rangeOf(one, scale)}`;
}
