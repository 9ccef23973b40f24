// Of the study's rows those that a chart draws, each with its tooltip.

// The same place as the chosen cell on every axis but the sweep's.
function sweepCells() {
  const here = cellNow().places;
  return study.cells.filter((cell) =>
    cell.places.every((place, axis) => axis === state.axis || place === here[axis]));
}

// Pixels beside the place of a word, so that the bars of estimators do not hide each other.
const besides = (i, count) => Math.min(9, 60 / count) * (i - (count - 1) / 2);

function sweepRows() {
  const errors = [];
  const bounds = [];
  for (const cell of sweepCells()) {
    const place = cell.places[state.axis];
    const text = study.axes[state.axis].texts[place];
    const {positions} = study.axes[state.axis];
    const x = positions ? positions[place] : study.axes[state.axis].labels[place];
    cell.estimators.forEach((one, i) => {
      const metric = one.metrics[state.sweepMetric];
      const row = {estimator: one.name, x, place, beside: positions ? 0 : besides(i, cell.estimators.length)};
      if (metric) {
        const [low, high] = metric.band;
        errors.push({...row, mean: metric.mean, low, high,
          tooltip: `${labelOf(one.name)}, ${text}: ${withInterval(metric, state.sweepMetric)}, n = ${metric.n}${metric.surveys > 1 ? ` of ${metric.surveys} surveys` : ''}` +
            (metric.sd ? `, sd ${quantity(metric.sd, unitOf(state.sweepMetric))}` : '')});
      }
      for (const kind of ['empirical', 'estimated']) {
        const value = one.bounds && one.bounds[kind + '_m'];
        if (value === undefined || value === null || value === false) continue;
        bounds.push({...row, kind, value, tooltip: `${labelOf(one.name)}, ${text}: ${kind} ${quantity(value, 'm')}`});
      }
    });
  }
  const along = study.axes[state.axis].positions ? (a, b) => a.x - b.x : (a, b) => a.place - b.place;
  return {errors: errors.sort(along), bounds: bounds.sort(along)};
}

// The same place as the chosen cell on every other axis.
function regimeCells() {
  const here = cellNow().places;
  return study.cells.filter((cell) => cell.places.every((place, axis) => [study.regimes.across, study.regimes.up].includes(axis) || place === here[axis]));
}

// A mean beside others: over the trials that estimators are ranked by, where it is.
const rankedOf = (metric) => (metric && metric.ranked) || metric;

const regimeIsRelative = () => study.metrics[state.regimeMetric].better === 'lower' && !unranked(state.regimeMetric);

function regimeRow(cell) {
  const {across, up} = study.regimes;
  return {x: study.axes[across].labels[cell.places[across]], y: study.axes[up].labels[cell.places[up]]};
}

function regimeRows(name) {
  return regimeCells().map((cell) => {
    const row = {...regimeRow(cell), estimator: name, stroke: styleOf(name).colour};
    const one = cell.estimators.find((other) => other.name === name);
    const own = one && one.metrics[state.regimeMetric];
    if (!own || !own.square) {
      const failed = one ? one.runs - one.done : 0;
      return {...row, fill: study.regimes.none, text: failed > 0 ? `${failed} failed` : '–',
        tooltip: `${labelOf(name)}: ${failed > 0 ? `${failed} of ${one.runs} trials failed` : own ? 'no value in trials where others have one, so in no comparison' : 'no value'}`};
    }
    const [fill, dark, relative] = own.square;
    const metric = regimeIsRelative() ? rankedOf(own) : own;
    return {...row, fill, dark, text: relative === null ? quantity(metric.mean, unitOf(state.regimeMetric)) : digits(relative),
      tooltip: `${labelOf(name)}: ${metricTitle(state.regimeMetric)} ${withInterval(metric, state.regimeMetric)}`};
  });
}

function cheapestRows() {
  return regimeCells().filter((cell) => cell.cheapest).map((cell) => {
    const {estimator} = cell.cheapest;
    return {...regimeRow(cell), ...cell.cheapest, stroke: styleOf(estimator).colour,
      text: (cell.verdict.as_cheap.length > 0 ? '? ' : '') + labelOf(estimator), tooltip: cell.verdict.cost.join('\n') || labelOf(estimator)};
  });
}

function keyframeRows(cell) {
  const rows = {error: [], bounds: [], nees: []};
  for (const one of cell.estimators) {
    const all = one.keyframes;
    const row = {estimator: one.name, label: labelOf(one.name)};
    all.keyframe.forEach((k, i) => {
      const mean = all.mean_m[i];
      if (mean !== null) {
        rows.error.push({...row, k, mean, low: all.low_m[i], high: all.high_m[i],
          label: `${row.label}, keyframe ${k}: ${quantity(mean, 'm')}`});
      }
      for (const kind of ['empirical', 'estimated']) {
        const value = all[kind + '_m'][i];
        if (value !== null) rows.bounds.push({...row, k, kind, value, label: `${row.label}, keyframe ${k}: ${kind} ${quantity(value, 'm')}`});
      }
      if (all.anees[i] > 0) rows.nees.push({...row, k, value: all.anees[i], label: `${row.label}, keyframe ${k}: ${digits(all.anees[i])}`});
    });
  }
  const {keyframe, low, high, draws} = cell.nees_interval;
  rows.interval = keyframe.map((k, i) => ({k, low: low[i], high: high[i]}));
  return {...rows, draws};
}

function updateRows(cell) {
  return cell.estimators.flatMap((one) => one.updates.keyframe.map((k, i) => ({
    estimator: one.name, k, piece: `${one.name} ${one.updates.piece[i]}`, value: one.updates.median_ms[i],
    label: `${labelOf(one.name)}, keyframe ${k}: ${quantity(one.updates.median_ms[i], 'ms')}`,
  }))).filter((row) => row.value > 0);
}

const sigmaAngles = Array.from({length: 33}, (_, i) => (i * Math.PI) / 16);

// The 2σ ellipse of a keyframe as a closed line.
function ellipseRows(name, [k, x, y, ...axes]) {
  return sigmaAngles.map((angle) => ({
    estimator: name, id: name + ' ' + k,
    x: x + axes[0] * Math.cos(angle) + axes[1] * Math.sin(angle),
    y: y + axes[2] * Math.cos(angle) + axes[3] * Math.sin(angle),
  }));
}

function pathRows(name, path) {
  return path ? path.x_m.map((x, i) => ({estimator: name, label: labelOf(name), x, y: path.y_m[i]})) : [];
}

function loopRows(one) {
  return one.loops.map(([from, to, fate, nis, x1, y1, x2, y2]) => ({
    estimator: one.name, fate, older: Math.min(from, to), newer: Math.max(from, to), x1, y1, x2, y2,
    tooltip: `${labelOf(one.name)}, ${from} to ${to}: ${study.fates[fate]}` + (nis === null ? '' : `, NIS ${digits(nis)}`),
  }));
}

function trajectoryRows(cell) {
  const rows = {paths: pathRows(kTruth, cell.example.truth), ellipses: [], loops: []};
  for (const one of cell.example.estimators) {
    rows.paths.push(...pathRows(one.name, one.path));
    rows.ellipses.push(...one.ellipses.flatMap((entry) => ellipseRows(one.name, entry)));
    rows.loops.push(...loopRows(one).filter((row) => row.y2 !== undefined));
  }
  return {...rows, ...markRows(cell)};
}

// One row an estimator that has the metric; those that are worse than the best are said.
function forestRows(cell) {
  const ranking = cell.rankings[state.metric];
  return cell.estimators.filter((one) => one.metrics[state.metric]).map((one) => {
    const metric = rankedOf(one.metrics[state.metric]);
    const {mean, low = mean, high = mean} = metric;
    return {estimator: one.name, label: labelOf(one.name), mean, low, high, text: quantity(mean, unitOf(state.metric)),
      open: standingOf(ranking, one.name) === 'worse',
      tooltip: `${labelOf(one.name)}: ${withInterval(metric, state.metric)}, n = ${metric.n}`};
  });
}

// Beside the best of a cell: 'best', 'equivalent', 'worse' or 'not_shown'; empty where it is not
// ranked or has no interval.
function standingOf(ranking, name) {
  if (!ranking) return '';
  if (ranking.best === name) return 'best';
  const other = ranking.others.find((one) => one.estimator === name);
  return other ? other.standing : '';
}

function paretoRows(cell) {
  const rows = [];
  const baseline = [];
  for (const one of cell.estimators) {
    const ranks = [state.accuracy, state.cost].map((name) => one.metrics[name] && one.metrics[name].rank);
    const [error, cost] = [state.accuracy, state.cost].map((name) => (ranks.includes(undefined) ? one.metrics[name] : rankedOf(one.metrics[name])));
    if (!error) continue;
    const low = error.low === undefined ? error.mean : error.low;
    const high = error.high === undefined ? error.mean : error.high;
    if (cost && cost.mean > 0) {
      rows.push({estimator: one.name, cost: cost.mean, mean: error.mean, low, high, front: false, ranks,
        x_low: cost.low > 0 ? cost.low : cost.mean, x_high: cost.high > 0 ? cost.high : cost.mean,
        tooltip: `${labelOf(one.name)}: ${metricTitle(state.accuracy)} ${withInterval(error, state.accuracy)}, ` +
          `${metricTitle(state.cost)} ${withInterval(cost, state.cost)}`});
    } else if (one.name === kBaseline) {
      baseline.push({estimator: one.name, mean: error.mean,
        tooltip: `${labelOf(one.name)}: ${withInterval(error, state.accuracy)}, at no cost`});
    }
  }
  // On the front are those of the shown ones that none of these beats: as pareto_front in C++, which
  // knows nothing of what the reader hides. Without a rank are those that are in no comparison.
  const shown = rows.filter((row) => !state.hidden.has(row.estimator));
  const beats = (a, b) => a.ranks.every((rank, i) => rank <= b.ranks[i]) && a.ranks.some((rank, i) => rank < b.ranks[i]);
  for (const row of shown) row.front = !row.ranks.includes(undefined) && !shown.some((other) => beats(other, row));
  return {rows, baseline};
}

function outcomeRows(cell) {
  return cell.estimators.filter((one) => one.name !== kBaseline).flatMap((one) => {
    return Object.entries(one.outcomes).map(([name, count], order) => {
      const text = `${count} ${name.replaceAll('_', ' ')}`;
      return {estimator: one.name, label: labelOf(one.name), outcome: name, count, text, order, tooltip: `${labelOf(one.name)}: ${text}`};
    });
  });
}
