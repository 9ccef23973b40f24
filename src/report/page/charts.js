// The plots that each chart is made of, from the rows and the width of its card.
const widthOf = (card) => Math.max(260, card.clientWidth - 34);
const halves = (card) => (widthOf(card) > 800 ? Math.floor((widthOf(card) - 20) / 2) : widthOf(card));
const thirds = (card) => (widthOf(card) > 1000 ? Math.floor((widthOf(card) - 40) / 3) : widthOf(card));

const isShown = (name) => !state.hidden.has(name);
const sum = (list) => list.reduce((a, b) => a + b, 0);

function extentOf(paths) {
  const extent = {x0: Infinity, x1: -Infinity, y0: Infinity, y1: -Infinity};
  for (const {x, y} of paths) {
    extent.x0 = Math.min(extent.x0, x);
    extent.x1 = Math.max(extent.x1, x);
    extent.y0 = Math.min(extent.y0, y);
    extent.y1 = Math.max(extent.y1, y);
  }
  return extent;
}

// What the map shows at first: all, unless dead reckoning or a run that failed is so far off that
// the rest could not be seen.
function mapExtent(paths) {
  const failed = cellNow().example.estimators.filter((one) => ['diverged', 'numerical_failure'].includes(one.outcome));
  const strays = [kBaseline, ...failed.map((one) => one.name)];
  const near = paths.filter((row) => !strays.includes(row.estimator));
  const [all, most] = [extentOf(paths), extentOf(near)];
  const sizeOf = (extent) => Math.max(extent.x1 - extent.x0, extent.y1 - extent.y0);
  return near.length === 0 || sizeOf(all) <= 2.5 * sizeOf(most) ? all : most;
}

function trajectoryPlots(card) {
  const rows = trajectoryRows(cellNow());
  const width = widthOf(card) - 70;
  const height = Math.min(620, Math.max(360, Math.round(width * 0.5)));
  const {x0, x1, y0, y1} = mapExtent(rows.paths);
  const metresPerPixel = 1.08 * Math.max((y1 - y0) / width, (x1 - x0) / height, 1e-6);
  const around = (middle, pixels) => [middle - (pixels * metresPerPixel) / 2, middle + (pixels * metresPerPixel) / 2];
  const signals = {start_h: around((y0 + y1) / 2, width).reverse(), start_v: around((x0 + x1) / 2, height),
    show_ellipses: state.show_ellipses, show_loops: state.show_loops};
  return [{spec: 'trajectories', data: rows, width, height, signals}];
}

function sweepPlots(card) {
  const {errors, bounds} = sweepRows();
  const signals = {x_title: study.axes[state.axis].name};
  const adjust = (spec) => {
    if (!sweepIsNumeric()) return;
    const scale = spec.scales.find((one) => one.name === 'x');
    Object.assign(scale, {type: 'linear', zero: false, nice: false, padding: 20, domain: {data: 'rows', field: 'x'}});
    spec.axes[0].values = study.axes[state.axis].labels.map(Number);
  };
  const width = halves(card);
  const plots = [{spec: 'sweep_error', heading: 'Mean over trials and its 2σ band', data: {rows: errors}, width,
    signals: {...signals, y_title: metricLabel(state.sweepMetric)}, adjust}];
  if (bounds.length > 0) {
    plots.push({spec: 'sweep_bounds', heading: 'Empirical (solid) and estimated (dashed) 2σ', data: {rows: bounds}, width, signals, adjust});
  }
  return plots;
}

function regimePlots(card) {
  const [across, up] = regimeAxes();
  const signals = {x_title: study.axes[across].name, y_title: study.axes[up].name};
  const domains = [study.axes[across].labels, study.axes[up].labels];
  const height = Math.max(110, 30 * domains[1].length + 50);
  const adjust = (spec) => domains.forEach((domain, i) => { spec.scales[i].domain = domain; });
  const plot = (heading, rows) => ({spec: 'regimes', heading, data: {rows}, width: thirds(card), height, signals, adjust});
  const plots = study.estimators.filter((one) => one.name !== kBaseline)
    .map((one) => plot(one.label, regimeRows(one.name)));
  return study.regimes ? [...plots, plot('Cheapest of the best', cheapestRows())] : plots;
}

// 1, 2 and 5 times the powers of ten between the least and the greatest.
function roundValues(values) {
  const low = Math.min(...values);
  const high = Math.max(...values);
  const decades = Array.from({length: 13}, (_, i) => Number(`1e${i - 6}`));
  return decades.flatMap((ten) => [ten, 2 * ten, 5 * ten]).filter((value) => value >= low && value <= high);
}

function keyframePlots(card) {
  const rows = keyframeRows(cellNow());
  const width = thirds(card);
  return [
    {spec: 'keyframe_error', heading: 'Position error and its 2σ band', data: {rows: rows.error}, width},
    {spec: 'keyframe_bounds', heading: 'Empirical (solid) and estimated (dashed) 2σ', data: {rows: rows.bounds}, width},
    {spec: 'keyframe_nees', heading: `NEES / 3 and the χ² interval of ${rows.draws} independent draw${rows.draws === 1 ? '' : 's'}`,
      data: {rows: rows.nees, interval: rows.interval}, width,
      adjust: (spec) => { spec.axes[1].values = roundValues([...rows.nees.map((row) => row.value), ...rows.interval.flatMap((row) => [row.low, row.high])]); }},
  ].filter((plot) => plot.data.rows.length > 0);
}

function updatePlots(card) {
  const rows = updateRows(cellNow());
  return rows.length > 0 ? [{spec: 'update_cost', data: {rows}, width: widthOf(card)}] : [];
}

function paretoPlots(card) {
  const data = paretoRows(cellNow());
  if (data.rows.length === 0) return [];
  const signals = {x_title: metricLabel(state.cost), y_title: metricLabel(state.accuracy)};
  return [{spec: 'pareto', data, width: widthOf(card), signals}];
}

function registrationPlots(card) {
  const drawn = cellNow().example.estimators.filter((one) => one.loops.length > 0);
  const shown = drawn.filter((one) => isShown(one.name));
  const ends = drawn.flatMap((one) => one.loops.map(([from, to]) => Math.max(from, to)));
  const columns = Math.max(2, Math.min(3, drawn.length));
  const side = Math.min(330, Math.floor(widthOf(card) / (widthOf(card) > 700 ? columns : 1)) - 75);
  const fates = ['used', 'rejected', 'lost'];
  const countOf = (one, fate) => one.loops.filter((loop) => loop[2] === fate).length;
  const countsText = (one) => fates.map((name, fate) => [countOf(one, fate), name])
    .filter(([n], fate) => n > 0 || fate === 0).map((pair) => pair.join(' ')).join(', ');
  return shown.map((one) => ({
    spec: 'registrations', width: side, height: side, data: {rows: loopRows(one)},
    heading: `${labelOf(one.name)}: ${countsText(one)}`,
    signals: {last: Math.max(1, ...ends)},
  }));
}

function outcomePlots(card) {
  const rows = outcomeRows(cellNow());
  const height = 60 + 44 * new Set(rows.map((row) => row.estimator)).size;
  return rows.length > 0 ? [{spec: 'outcomes', data: {rows}, width: widthOf(card), height}] : [];
}
