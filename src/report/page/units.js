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

// A number with three digits.
function digits(value, count = 3) {
  if (value === null || value === undefined) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e7 || size < 1e-4) {
    const [mantissa, exponent] = value.toExponential(count - 1).split('e');
    return `${mantissa} × ${powerOfTen(Number(exponent))}`;
  }
  const whole = Math.floor(Math.log10(size)) + 1;
  return value.toFixed(Math.min(8, Math.max(0, count - whole)));
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

// "17.4 mm [16.1, 18.4]" of a mean of a metric.
function withInterval(one, metric) {
  const scale = readingUnit(unitOf(metric), greatestOf([one.mean, one.low, one.high]));
  const interval = one.low === undefined ? '' : ` [${numberIn(one.low, scale)}, ${numberIn(one.high, scale)}]`;
  return followedBy(numberIn(one.mean, scale), scale.text) + interval;
}
