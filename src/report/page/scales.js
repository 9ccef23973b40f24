// How rows fit an axis: linear or logarithmic, in which unit, and with dead reckoning or without.
const kWide = 100;  // greatest over least: what spans less is read better on a linear axis
const kHides = 5;  // times the others: what lies so far above them leaves no scale for the rest

const isOf = (kind, usual) => (state.axes === 'usual' ? usual : state.axes) === kind;

function isWide(values) {
  const positive = values.filter((value) => value > 0);
  return positive.length > 0 && Math.max(...positive) >= kWide * Math.min(...positive) * (1 - 1e-9);
}

// 1, 2 and 5 times the powers of ten between the least and the greatest; of many decades the powers,
// of less than one all digits.
function roundValues(low, high) {
  const decades = Array.from({length: 41}, (_, i) => Number(`1e${i - 20}`));
  const steps = high < 6 * low ? [1, 2, 3, 4, 5, 6, 7, 8, 9] : high < 300 * low ? [1, 2, 5] : [1];
  return decades.flatMap((ten) => steps.map((step) => Number((step * ten).toPrecision(1)))).filter((value) => value >= low && value <= high);
}

// Ends near the values, and all that is labelled is seen.
function setLogarithmic(scale, axis, values) {
  const positive = values.filter((value) => value > 0);
  const [low, high] = [0.9 * Math.min(...positive), 1.1 * Math.max(...positive)];
  Object.assign(scale, {type: 'log', nice: false, domain: [low, high]});
  delete scale.zero;
  delete axis.tickCount;  // by which values that are given are thinned
  Object.assign(axis, {format: '~g', labelOverlap: 'greedy', values: roundValues(low, high)});
}

// Rows in the unit of their axis. `fields` are the values along it, the one that counts first;
// `usual` is what the axis is unless the reader says, 'wide' logarithmic where the values span two
// decades. `off` is how high dead reckoning is where it
// is left out.
function fitted(rows, fields, unit, usual = 'linear') {
  const of = (list, names) => list.flatMap((row) => names.map((name) => row[name])).filter((value) => Number.isFinite(value));
  const shown = rows.filter((row) => row.estimator === undefined || isShown(row.estimator));
  const main = fields.slice(0, 1);
  const wanted = usual !== 'wide' ? usual : isWide(of(shown, main)) ? 'log' : 'linear';
  const logarithmic = isOf('log', wanted) && of(shown, main).some((value) => value > 0) &&
    !of(shown, main).some((value) => value < 0);
  const baseline = shown.filter((row) => row.estimator === kBaseline);
  const others = shown.filter((row) => row.estimator !== kBaseline);
  const highest = greatestOf(of(baseline, main));
  const hides = !logarithmic && !state.baselineOnScale && others.length > 0 &&
    highest > kHides * greatestOf(of(others, main));
  let kept = hides ? others : shown;
  if (logarithmic) {
    kept = kept.filter((row) => row[main[0]] > 0);
    // What reaches below zero is drawn down to the least value.
    const least = of(kept, main).reduce((a, b) => Math.min(a, b), Infinity);
    kept = kept.map((row) => ({...row, ...Object.fromEntries(fields.slice(1).map((name) => [name, Math.max(row[name], least / 2)]))}));
  }
  const scale = readingUnit(unit, greatestOf(of(kept, fields)));
  const scaled = (row) => ({...row, ...Object.fromEntries(fields.filter((name) => Number.isFinite(row[name])).map((name) => [name, row[name] * scale.factor]))});
  const scaledRows = kept.map(scaled);
  return {rows: scaledRows, values: of(scaledRows, fields), logarithmic, unit: scale.text, factor: scale.factor,
    off: hides ? `${baseline.length > 1 ? 'up to ' : ''}${quantity(highest, unit)}` : '',
    refused: isOf('log', wanted) && !logarithmic && shown.length > 0};
}

// Makes an axis of a specification as its rows were fitted.
function setScale(spec, name, fit) {
  const scale = spec.scales.find((one) => one.name === name);
  const axis = spec.axes.find((one) => one.scale === name);
  if (fit.logarithmic) {
    setLogarithmic(scale, axis, fit.values);
  } else {
    scale.type = 'linear';
    delete axis.format;
  }
}

// Names that are the same as the first of their group.
function groupsOf(names, areSame) {
  const groups = [];
  for (const name of names) {
    const group = groups.find(([first]) => areSame(first, name));
    if (group) group.push(name);
    else groups.push([name]);
  }
  return groups.filter((group) => group.length > 1);
}

// "a, b and c; d and e"
const groupsText = (groups) => groups.map((group) => namesOf(group.map(labelOf))).join('; ');

// Estimators whose lines are within a pixel of each other.
function coincidence(fit, field, keys) {
  const lines = new Map();
  for (const row of fit.rows) {
    if (!lines.has(row.estimator)) lines.set(row.estimator, new Map());
    const value = fit.logarithmic ? Math.log(row[field]) : row[field];
    lines.get(row.estimator).set(keys.map((key) => row[key]).join(' '), value);
  }
  const all = [...lines.values()].flatMap((line) => [...line.values()]);
  const [low, high] = [all.reduce((a, b) => Math.min(a, b), Infinity), all.reduce((a, b) => Math.max(a, b), -Infinity)];
  const pixel = (fit.logarithmic ? high - low : high - Math.min(0, low)) / 250;
  const same = (a, b) => a.size === b.size && [...a].every(([key, value]) => b.has(key) && Math.abs(value - b.get(key)) <= pixel);
  return groupsOf([...lines.keys()], (a, b) => same(lines.get(a), lines.get(b)));
}

// What stands below the plots of a chart.
function notesOf(plots) {
  const parts = [];
  const off = plots.filter((plot) => plot.off).map((plot) => `${plot.title} ${plot.off}`);
  if (off.length > 0) parts.push(`${sentence(labelOf(kBaseline))} is off the scale: ${namesOf(off)}.`);
  const alike = plots.filter((plot) => plot.same && plot.same.length > 0 && !plot.spread)
    .map((plot) => ({title: plot.title, text: groupsText(plot.same)}));
  const inAll = alike.length === plots.length && new Set(alike.map((plot) => plot.text)).size === 1;
  if (inAll) parts.push(`On one another, within a pixel: ${alike[0].text}.`);
  else parts.push(...alike.map((plot) => `On one another (${plot.title}), within a pixel: ${plot.text}.`));
  if (plots.some((plot) => plot.refused)) parts.push('Some values are not above zero: the axis is linear.');
  parts.push(...plots.map((plot) => plot.note).filter(Boolean));
  return parts.join(' ');
}
