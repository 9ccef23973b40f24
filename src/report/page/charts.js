// The plots that each chart is made of, from the rows and the width of its card.
const kGap = 18;
const widthOf = (card) => Math.max(260, card.clientWidth - 34);

// The width of each of some plots, in rows of as many as have the least width; every row is full.
function widthsOf(card, count, least = 380) {
  const most = Math.max(1, Math.floor((widthOf(card) + kGap) / (least + kGap)));
  const rows = Math.ceil(count / most);
  return Array.from({length: rows}, (_, row) => Math.floor(count / rows) + (row < count % rows ? 1 : 0))
    .flatMap((own) => Array(own).fill(Math.floor((widthOf(card) - kGap * (own - 1)) / own)));
}

const inRows = (card, plots, least) => {
  const widths = widthsOf(card, plots.length, least);
  return plots.map((plot, i) => ({...plot, width: widths[i]}));
};

// A plot of one set of rows whose values go up. `title` is its axis without the unit.
function fittedPlot({rows, fields, unit, usual, title, keys = ['k'], adjust, signals = {}, data = {}, ...plot}) {
  const fit = fitted(rows, fields, unit, usual);
  const same = coincidence(fit, fields[0], keys);
  return {...plot, fit, title, data: {...data, rows: fit.rows}, off: fit.off, refused: fit.refused,
    same, turns: keys.includes('kind') ? [] : same, signals: {...signals, y_title: titled(title, fit.unit)},
    adjust: (spec) => {
      setScale(spec, 'y', fit);
      if (adjust) adjust(spec, fit);
    }};
}

const isShown = (name) => !state.hidden.has(name);
const sum = (list) => list.reduce((a, b) => a + b, 0);

// What the map shows at first.
const mapExtent = () => cellNow().example.extent || {x_m: [-1, 1], y_m: [-1, 1]};

// A map that goes further up than to the sides leaves room beside it for another chart.
function mapIsTall() {
  const {x_m: [x0, x1], y_m: [y0, y1]} = mapExtent();
  return x1 - x0 > 1.2 * (y1 - y0);
}

// How far two paths are apart at most; infinite where one alone has a pose.
function apart(one, other) {
  if (one.length !== other.length) return Infinity;
  return greatestOf(one.map((row, k) =>
    ((row.x === null) === (other[k].x === null) ? Math.hypot(row.x - other[k].x, row.y - other[k].y) : Infinity)));
}

// Paths nearer to each other than a line is thick, and in words how near they are to each other and to the
// truth, which the thickness of a line would hide.
function coincidentPaths(paths, thickness_m) {
  const byName = new Map();
  for (const row of paths) {
    if (!byName.has(row.estimator)) byName.set(row.estimator, []);
    byName.get(row.estimator).push(row);
  }
  const estimates = [...byName.keys()].filter((name) => name !== kTruth && isShown(name));
  const same = groupsOf(estimates, (a, b) => apart(byName.get(a), byName.get(b)) <= thickness_m);
  const spread = same.map((group) => {
    const most = greatestOf(group.flatMap((a) => group.map((b) => apart(byName.get(a), byName.get(b)))));
    const truth = byName.has(kTruth) ? greatestOf(group.map((name) => apart(byName.get(name), byName.get(kTruth)))) : Infinity;
    return `${namesOf(group.map(labelOf))} ${most > 0 ? `lie within ${quantity(most, 'm')} of each other` : 'are the same'}` +
      `${Number.isFinite(truth) ? ` and within ${quantity(truth, 'm')} of ground truth` : ''}; their colours take turns on one line.`;
  }).join(' ');
  return {same, spread};
}

function trajectoryPlots(card) {
  const rows = trajectoryRows(cellNow());
  const width = widthOf(card) - 70;
  const height = Math.min(620, Math.max(360, Math.round(width * (mapIsTall() ? 0.8 : 0.5))));
  const {x_m: [x0, x1], y_m: [y0, y1]} = mapExtent();
  const metresPerPixel = 1.08 * Math.max((y1 - y0) / width, (x1 - x0) / height, 1e-6);
  const around = (middle, pixels) => [middle - (pixels * metresPerPixel) / 2, middle + (pixels * metresPerPixel) / 2];
  const signals = {start_h: around((y0 + y1) / 2, width).reverse(), start_v: around((x0 + x1) / 2, height),
    show_ellipses: state.show_ellipses, show_loops: state.show_loops, show_marks: state.show_marks};
  const {same, spread} = coincidentPaths(rows.paths, kShared * metresPerPixel);
  return [{spec: 'trajectories', data: rows, width, height, signals, same, turns: same, spread, title: 'map',
    note: [spread, beyondNote(rows.fixes, signals.start_h, signals.start_v)].filter(Boolean).join(' ')}];
}

// Estimators with the same picture share one, which has the colour of none. `seen` is what of a row
// is seen besides its colour.
function picturesOf(entries, seen) {
  const groups = new Map();
  for (const entry of entries) {
    const picture = JSON.stringify(entry.rows.map(seen));
    if (!groups.has(picture)) groups.set(picture, []);
    groups.get(picture).push(entry);
  }
  return [...groups.values()].map((group) => ({names: group.map((one) => one.name),
    rows: group.length === 1 ? group[0].rows
      : group[0].rows.map((row, i) => ({...row, shared: true, stroke: css('--soft'), tooltip: group.map((one) => one.rows[i].tooltip).join('\n')}))}));
}

function regimePlots(card) {
  const {across, up} = study.regimes;
  const signals = {x_title: study.axes[across].title, y_title: study.axes[up].title};
  const domains = [study.axes[across].labels, study.axes[up].labels];
  const height = Math.max(110, 30 * domains[1].length + 50, 7 * signals.y_title.length + 60);  // of the whole title
  const adjust = (spec) => domains.forEach((domain, i) => { spec.scales[i].domain = domain; });
  const plot = (heading, rows) => ({spec: 'regimes', heading, data: {rows}, height, signals, adjust});
  const plots = picturesOf(study.estimators.filter((one) => one.name !== kBaseline && isShown(one.name))
    .map(({name}) => ({name, rows: regimeRows(name)})), ({text, fill}) => [text, fill]).map(({names, rows}) => plot(namesOf(names.map(labelOf)), rows));
  return inRows(card, study.regimes.cheapest ? [...plots, plot('Cheapest of the best', cheapestRows())] : plots, 300);
}

function neesPlot(rows) {
  const heading = `NEES / 3 and the χ² interval of ${rows.draws} independent draw${rows.draws === 1 ? '' : 's'}`;
  return fittedPlot({spec: 'keyframe_nees', heading, rows: rows.nees, fields: ['value'], unit: '', usual: 'log',
    title: 'NEES / 3, mean over trials', data: {interval: rows.interval},
    adjust: (spec, fit) => {
      const drawn = [...fit.values, ...rows.interval.flatMap((row) => [row.low, row.high])];
      if (fit.logarithmic) setLogarithmic(spec.scales.find((scale) => scale.name === 'y'), spec.axes[1], drawn);
    }});
}

function keyframePlots(card) {
  const rows = keyframeRows(cellNow());
  const plots = [
    fittedPlot({spec: 'keyframe_error', heading: 'Position error and its 2σ band', rows: rows.error, fields: ['mean', 'low', 'high'],
      unit: 'm', title: 'position error'}),
    fittedPlot({spec: 'keyframe_bounds', heading: 'Empirical (solid) and estimated (dashed) 2σ', rows: rows.bounds, fields: ['value'],
      unit: 'm', title: '2σ of position', keys: ['k', 'kind']}),
    neesPlot(rows),
  ];
  return inRows(card, plots.filter((plot) => plot.data.rows.length > 0), 330);
}

function updatePlots(card) {
  const rows = updateRows(cellNow());
  if (rows.length === 0) return [];
  return inRows(card, [fittedPlot({spec: 'update_cost', rows, fields: ['value'], unit: 'ms', usual: 'wide', title: 'time of an update'})]);
}

function paretoPlots(card) {
  const {rows, baseline} = paretoRows(cellNow());
  if (rows.length === 0) return [];
  const y = fitted([...rows, ...baseline], ['mean', 'low', 'high'], unitOf(state.accuracy));
  const x = fitted(y.rows.filter((row) => row.cost !== undefined), ['cost', 'x_low', 'x_high'], unitOf(state.cost), 'wide');
  const data = {rows: x.rows, baseline: y.rows.filter((row) => row.cost === undefined),
    front: x.rows.filter((row) => row.front).sort((a, b) => a.cost - b.cost)};
  const signals = {x_title: titled(metricTitle(state.cost), x.unit), y_title: titled(metricTitle(state.accuracy), y.unit)};
  const adjust = (spec) => {
    setScale(spec, 'x', x);
    setScale(spec, 'y', y);
  };
  return inRows(card, [{spec: 'pareto', data, signals, adjust, title: metricTitle(state.accuracy), off: y.off, refused: x.refused || y.refused}]);
}

function forestPlots(card) {
  const fit = fitted(forestRows(cellNow()), ['mean', 'low', 'high'], unitOf(state.metric));
  if (fit.rows.length === 0) return [];
  const ranking = cellNow().rankings[state.metric];
  const best = fit.rows.filter((row) => ranking && row.estimator === ranking.best);
  const names = fit.rows.map((row) => row.estimator);
  const adjust = (spec) => {
    setScale(spec, 'x', fit);
    Object.assign(spec.scales.find((scale) => scale.name === 'y'), {domain: names});
    for (const [name, field] of [['label', 'label'], ['text', 'text']]) {
      Object.assign(spec.scales.find((scale) => scale.name === name), {domain: names, range: fit.rows.map((row) => row[field])});
    }
  };
  return inRows(card, [{spec: 'forest', data: {rows: fit.rows, best}, height: 70 + 34 * names.length, title: metricTitle(state.metric), off: fit.off, refused: fit.refused,
    signals: {x_title: titled(metricTitle(state.metric), fit.unit)}, adjust}]);
}

// Of very many loops only some are drawn.
function thinnedNote(one) {
  return one.loops.length < sum(Object.values(one.loops_in_all)) ? `; ${one.loops.length} drawn` : '';
}

const withLoops = () => cellNow().example.estimators.filter((one) => one.loops.length > 0);

function registrationPictures() {
  const shown = withLoops().filter((one) => isShown(one.name));
  return picturesOf(shown.map((one) => ({name: one.name, rows: loopRows(one)})), ({older, newer, fate}) => [older, newer, fate]);
}

function registrationPlots(card) {
  const drawn = withLoops();
  const pictures = registrationPictures();
  const ends = drawn.flatMap((one) => one.loops.map(([from, to]) => Math.max(from, to)));
  const most = Math.max(1, Math.min(4, Math.floor(widthOf(card) / 260)));
  const columns = Math.ceil(pictures.length / Math.ceil(pictures.length / most));
  const side = Math.min(460, Math.floor((widthOf(card) - kGap * (columns - 1)) / columns) - 75);
  const countsText = (one) => Object.entries(one.loops_in_all).filter(([fate, n]) => n > 0 || fate === 'used')
    .map(([fate, n]) => `${n} ${fate}`).join(', ') + thinnedNote(one);
  return pictures.map(({names, rows}) => ({
    spec: 'registrations', width: side, height: side, data: {rows},
    heading: `${namesOf(names.map(labelOf))}: ${countsText(drawn.find((one) => one.name === names[0]))}`,
    signals: {last: Math.max(1, ...ends)},
  }));
}

function outcomePlots(card) {
  const rows = outcomeRows(cellNow());
  const height = 60 + 44 * new Set(rows.map((row) => row.estimator)).size;
  return rows.length > 0 ? [{spec: 'outcomes', data: {rows}, width: widthOf(card), height}] : [];
}
