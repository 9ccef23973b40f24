// From the study's data to the rows that each chart draws.
const kFates = ['used', 'rejected by the gate', 'lost with a failed update'];

// The same place as the chosen cell on every axis but the sweep's.
function sweepCells() {
  const here = cellNow().places;
  return study.cells.filter((cell) =>
    cell.places.every((place, axis) => axis === state.axis || place === here[axis]));
}

function sweepRows() {
  const errors = [];
  const bounds = [];
  for (const cell of sweepCells()) {
    const place = cell.places[state.axis];
    const text = study.axes[state.axis].labels[place];
    const x = sweepIsNumeric() ? Number(text) : text;
    for (const one of cell.estimators) {
      const metric = one.metrics[state.sweepMetric];
      const row = {estimator: one.name, x, place};
      if (metric) {
        const spread = 2 * (metric.sd || 0);
        const low = metric.mean >= 0 ? Math.max(0, metric.mean - spread) : metric.mean - spread;
        errors.push({...row, mean: metric.mean, low, high: metric.mean + spread,
          tooltip: `${labelOf(one.name)}, ${text}: ${withInterval(metric, state.sweepMetric)}, n = ${metric.n}${metric.surveys > 1 ? ` of ${metric.surveys} surveys` : ''}` +
            (metric.sd ? `, sd ${quantity(metric.sd, unitOf(state.sweepMetric))}` : '')});
      }
      for (const kind of ['empirical', 'estimated']) {
        const value = one.bounds && one.bounds[kind + '_m'];
        if (value === undefined || value === null || value === false) continue;
        bounds.push({...row, kind, value, tooltip: `${labelOf(one.name)}, ${text}: ${kind} ${quantity(value, 'm')}`});
      }
    }
  }
  const byPlace = (a, b) => a.place - b.place;
  return {errors: errors.sort(byPlace), bounds: bounds.sort(byPlace)};
}

const sweepIsNumeric = () =>
  study.axes[state.axis].labels.every((label) => label.trim() !== '' && Number.isFinite(Number(label)));

// The first two axes with several values.
const regimeAxes = () => study.axes.map((axis, i) => i).filter((i) => study.axes[i].labels.length > 1).slice(0, 2);

// The same place as the chosen cell on every other axis.
function regimeCells() {
  const here = cellNow().places;
  return study.cells.filter((cell) => cell.places.every((place, axis) => regimeAxes().includes(axis) || place === here[axis]));
}

const regimeIsRelative = () => study.metrics[state.regimeMetric].better === 'lower';

function regimeRow(cell) {
  const [across, up] = regimeAxes();
  return {x: study.axes[across].labels[cell.places[across]], y: study.axes[up].labels[cell.places[up]]};
}

// Estimators that failed no trial: the mean of another leaves out the hardest.
function regimeMean(cell, name) {
  const one = cell.estimators.find((other) => other.name === name);
  const metric = one && one.done === one.runs && one.metrics[state.regimeMetric];
  return metric ? metric.mean : undefined;
}

const mixed = (colour, share) => {
  const channels = [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16));
  return `rgb(${channels.map((value) => Math.round(255 + share * (value - 255))).join(',')})`;
};

function regimeRows(name) {
  const cells = regimeCells();
  const names = study.estimators.map((one) => one.name).filter((other) => other !== kBaseline);
  const all = cells.flatMap((cell) => names.map((other) => regimeMean(cell, other))).filter((value) => value !== undefined);
  const [least, most] = [Math.min(...all), Math.max(...all)];
  return cells.map((cell) => {
    const row = {...regimeRow(cell), estimator: name, stroke: styleOf(name).colour};
    const one = cell.estimators.find((other) => other.name === name);
    const mean = regimeMean(cell, name);
    if (mean === undefined) {
      const failed = one ? one.runs - one.done : 0;
      return {...row, fill: mixed('#8a8a8a', 0.35), ink: '#000000', text: failed > 0 ? `${failed} failed` : '–',
        tooltip: `${labelOf(name)}: ${failed > 0 ? `${failed} of ${one.runs} trials failed` : 'no value'}`};
    }
    const best = Math.min(...names.map((other) => regimeMean(cell, other)).filter((value) => value !== undefined));
    const relative = regimeIsRelative() && best > 0;
    const value = relative ? mean / best : mean;
    const share = relative ? Math.min(1, Math.log(value) / Math.log(10)) : most > least ? (mean - least) / (most - least) : 0;
    return {...row, fill: mixed('#0072b2', 0.06 + 0.94 * share), ink: share > 0.5 ? '#ffffff' : '#000000', text: relative ? digits(value) : quantity(value, unitOf(state.regimeMetric)),
      tooltip: `${labelOf(name)}: ${metricTitle(state.regimeMetric)} ${withInterval(one.metrics[state.regimeMetric], state.regimeMetric)}`};
  });
}

function cheapestRows() {
  return regimeCells().filter((cell) => cell.cheapest).map((cell) => ({...regimeRow(cell), estimator: cell.cheapest,
    fill: mixed(styleOf(cell.cheapest).colour, 0.55), stroke: styleOf(cell.cheapest).colour, ink: '#000000',
    text: labelOf(cell.cheapest), tooltip: labelOf(cell.cheapest)}));
}

function keyframeRows(cell) {
  const rows = {error: [], bounds: [], nees: [], interval: []};
  for (const one of cell.estimators) {
    const all = one.keyframes;
    const row = {estimator: one.name, label: labelOf(one.name)};
    all.keyframe.forEach((k, i) => {
      const mean = all.mean_m[i];
      if (mean !== null) {
        const spread = 2 * (all.sd_m[i] || 0);
        rows.error.push({...row, k, mean, low: Math.max(0, mean - spread), high: mean + spread,
          label: `${row.label}, keyframe ${k}: ${quantity(mean, 'm')}`});
      }
      for (const kind of ['empirical', 'estimated']) {
        const value = all[kind + '_m'][i];
        if (value !== null) rows.bounds.push({...row, k, kind, value, label: `${row.label}, keyframe ${k}: ${kind} ${quantity(value, 'm')}`});
      }
      if (all.anees[i] > 0) rows.nees.push({...row, k, value: all.anees[i], label: `${row.label}, keyframe ${k}: ${digits(all.anees[i])}`});
    });
  }
  // The estimator with the most independent draws has the interval drawn.
  const drawsOf = (one) => Math.max(0, ...one.keyframes.nees_draws);
  const most = cell.estimators.reduce((a, b) => (drawsOf(b) > drawsOf(a) ? b : a));
  most.keyframes.keyframe.forEach((k, i) => {
    const {low, high} = most.keyframes.nees_interval;
    if (low[i] !== null) rows.interval.push({k, low: low[i], high: high[i]});
  });
  rows.draws = drawsOf(most);
  return rows;
}

function updateRows(cell) {
  return cell.estimators.flatMap((one) => one.updates.keyframe.map((k, i) => ({
    estimator: one.name, k, value: one.updates.median_ms[i],
    label: `${labelOf(one.name)}, keyframe ${k}: ${quantity(one.updates.median_ms[i], 'ms')}`,
  }))).filter((row) => row.value > 0);
}

const sigmaAngles = Array.from({length: 33}, (_, i) => (i * Math.PI) / 16);

// The 2σ ellipse of a keyframe as a closed line.
function ellipseRows(name, [k, x, y, xx, xy, yy]) {
  const a = Math.sqrt(Math.max(0, xx));
  const b = a > 0 ? xy / a : 0;
  const c = Math.sqrt(Math.max(0, yy - b * b));
  return sigmaAngles.map((angle) => ({
    estimator: name, id: name + ' ' + k,
    x: x + 2 * a * Math.cos(angle),
    y: y + 2 * (b * Math.cos(angle) + c * Math.sin(angle)),
  }));
}

function pathRows(name, path) {
  return path ? path.x_m.map((x, i) => ({estimator: name, label: labelOf(name), x, y: path.y_m[i]})) : [];
}

function loopRows(one) {
  return one.loops.flatMap(([from, to, fate, nis], i) => {
    const ends = one.loop_ends_m[i];
    const tooltip = `${labelOf(one.name)}, ${from} to ${to}: ${kFates[fate]}` +
      (nis === null ? '' : `, NIS ${digits(nis)}`);
    const row = {estimator: one.name, fate, tooltip, older: Math.min(from, to), newer: Math.max(from, to)};
    return [ends ? {...row, x1: ends[0], y1: ends[1], x2: ends[2], y2: ends[3]} : row];
  });
}

function trajectoryRows(cell) {
  const rows = {paths: pathRows(kTruth, cell.example.truth), ellipses: [], loops: []};
  for (const one of cell.example.estimators) {
    rows.paths.push(...pathRows(one.name, one.path));
    rows.ellipses.push(...one.ellipses.flatMap((entry) => ellipseRows(one.name, entry)));
    rows.loops.push(...loopRows(one).filter((row) => row.x1 !== undefined));
  }
  return {...rows, ...markRows(cell)};
}

// One row an estimator that has the metric; those told apart from the best are said.
function forestRows(cell) {
  const ranking = cell.rankings[state.metric];
  return cell.estimators.filter((one) => one.metrics[state.metric]).map((one) => {
    const metric = one.metrics[state.metric];
    const {mean, low = mean, high = mean} = metric;
    return {estimator: one.name, label: labelOf(one.name), mean, low, high, text: quantity(mean, unitOf(state.metric)),
      open: standingOf(ranking, one.name) === 'worse',
      tooltip: `${labelOf(one.name)}: ${withInterval(metric, state.metric)}, n = ${metric.n}`};
  });
}

// Beside the best of a cell: 'best', 'alike' where it cannot be told apart, 'worse'; empty where it
// is not ranked or has no interval.
function standingOf(ranking, name) {
  if (!ranking) return '';
  if (ranking.best === name) return 'best';
  const other = ranking.others.find((one) => one.estimator === name);
  if (!other || other.low === undefined) return '';
  return other.told_apart ? 'worse' : 'alike';
}

function paretoRows(cell) {
  const rows = [];
  const baseline = [];
  for (const one of cell.estimators) {
    const error = one.metrics[state.accuracy];
    const cost = one.metrics[state.cost];
    if (!error) continue;
    const low = error.low === undefined ? error.mean : error.low;
    const high = error.high === undefined ? error.mean : error.high;
    if (cost && cost.mean > 0) {
      rows.push({estimator: one.name, cost: cost.mean, mean: error.mean, low, high, front: false,
        x_low: cost.low > 0 ? cost.low : cost.mean, x_high: cost.high > 0 ? cost.high : cost.mean,
        tooltip: `${labelOf(one.name)}: ${metricTitle(state.accuracy)} ${withInterval(error, state.accuracy)}, ` +
          `${metricTitle(state.cost)} ${withInterval(cost, state.cost)}`});
    } else if (one.name === kBaseline) {
      baseline.push({estimator: one.name, mean: error.mean,
        tooltip: `${labelOf(one.name)}: ${withInterval(error, state.accuracy)}, at no cost`});
    }
  }
  // The cheaper the better, and the metric says which of its values is; of some neither.
  const {better} = study.metrics[state.accuracy];
  const sign = better === 'higher' ? -1 : 1;
  const front = [];
  const shown = rows.filter((row) => !state.hidden.has(row.estimator));
  for (const row of shown.sort((a, b) => a.cost - b.cost || sign * (a.mean - b.mean))) {
    row.front = better !== 'neither' && (front.length === 0 || sign * row.mean < sign * front[front.length - 1].mean);
    if (row.front) front.push(row);
  }
  return {rows, front, baseline};
}

function outcomeRows(cell) {
  const order = ['converged', 'iteration_limit', 'diverged', 'numerical_failure', 'crashed', 'timed_out',
    'out_of_memory', 'not run'];
  return cell.estimators.filter((one) => one.name !== kBaseline).flatMap((one) => {
    const counts = {...one.outcomes, 'not run': Math.max(0, study.surveys * study.trials - one.runs)};
    return order.filter((name) => counts[name] > 0).map((name) => {
      const text = `${counts[name]} ${name.replaceAll('_', ' ')}`;
      return {estimator: one.name, label: labelOf(one.name), count: counts[name], text,
        order: order.indexOf(name), tooltip: `${labelOf(one.name)}: ${text}`};
    });
  });
}
