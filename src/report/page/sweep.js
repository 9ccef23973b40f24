// The plots of a sweep, and the labels of its axis.
const kLineOfText = 13;
const kSmallestLine = 9;

// Places on a line of `length`, moved no more than is needed to be a pitch apart.
function spread(places, length, pitch) {
  const moved = [];
  places.forEach((place, i) => moved.push(Math.max(place, i > 0 ? moved[i - 1] + pitch : 0)));
  for (let i = moved.length - 1; i >= 0; --i) moved[i] = Math.min(moved[i], i + 1 < moved.length ? moved[i + 1] - pitch : length);
  return moved;
}

// Of labels that stand on end their size, and those that are shown: every so many, where all would be too small.
function labelsOnEnd(count, length) {
  const every = Math.ceil((count * kSmallestLine) / length);
  const pitch = Math.min(kLineOfText, length / Math.max(1, Math.ceil(count / every) - 1));
  return {every, pitch, size: Math.min(11, pitch - 2)};
}

// The axis of a sweep has the labels that were given, at `values`, all of them. Where they would not fit side
// by side, as far apart as `places` are, they stand on end, and where that is too near, beside their ticks.
function labelSweep(spec, values, places) {
  const {ticks} = study.axes[state.axis];
  const length = spec.width - 110;
  const first = Math.min(...places);
  const perPlace = length / Math.max(1e-300, Math.max(...places) - first);
  const order = places.map((place, i) => ({value: values[i], text: ticks[i], at: (place - first) * perPlace})).sort((a, b) => a.at - b.at);
  const isTight = order.slice(1).some((one, i) => one.at - order[i].at < 3.6 * (one.text.length + order[i].text.length) + 8);
  const {every, pitch, size} = isTight ? labelsOnEnd(order.length, length) : {every: 1};
  const shown = order.filter((one, i) => i % every === 0);
  const shownAt = shown.map((one) => one.at);
  const moved = isTight ? spread(shownAt, length, pitch) : shownAt;
  const labels = Object.fromEntries(order.map(({value}) => [value, {text: '', shift: 0}]));
  shown.forEach(({value, text, at}, i) => Object.assign(labels[value], {text, shift: moved[i] - at}));
  spec.signals.push({name: 'labels', value: labels});
  const shift = {signal: 'labels[datum.value].shift'};
  // A tick leads from its value to its label.
  const toLabel = {x2: {scale: 'x', field: 'value', offset: shift}};
  Object.assign(spec.axes[0], {labelOverlap: false,
    encode: {labels: {update: {text: {signal: 'labels[datum.value].text'}, dy: shift}}, ticks: {update: toLabel}}});
  if (isTight) Object.assign(spec.axes[0], {labelAngle: -90, labelAlign: 'right', labelBaseline: 'middle', labelFontSize: size, tickSize: 9});
}

// Between words there is nothing: points with bars, and no line from one graph to another.
function takeApart(spec) {
  const [group] = spec.marks;
  const point = group.marks.at(-1);
  const band = group.marks.find((mark) => mark.type === 'area');
  const x = {scale: 'x', field: 'x', offset: {field: 'beside'}};
  const bars = band ? [{type: 'rule', from: {data: 'line'}, interactive: false, encode: {update: {x, y: band.encode.update.y, y2: band.encode.update.y2,
    stroke: band.encode.update.fill, strokeWidth: {value: 1.4}}}}] : [];
  Object.assign(point.encode.update, {x});
  const {labels} = study.axes[state.axis];
  labelSweep(spec, labels, labels.map((_, i) => i));
  group.marks = [...bars, point];
}

function sweepPlots(card) {
  const {errors, bounds} = sweepRows();
  const signals = {x_title: study.axes[state.axis].title};
  const {positions, logarithmic} = study.axes[state.axis];
  const adjust = (spec) => {
    if (!positions) return takeApart(spec);
    const scale = spec.scales.find((one) => one.name === 'x');
    Object.assign(scale, {type: logarithmic ? 'log' : 'linear', nice: false, padding: 20, domain: {data: 'rows', field: 'x'}});
    if (!logarithmic) scale.zero = false;
    spec.axes[0].values = positions;
    labelSweep(spec, positions, logarithmic ? positions.map(Math.log) : positions);
  };
  const plots = [fittedPlot({spec: 'sweep_error', heading: `Mean over trials and its 2σ ${positions ? 'band' : 'bar'}`, rows: errors, fields: ['mean', 'low', 'high'],
    unit: unitOf(state.sweepMetric), title: metricTitle(state.sweepMetric), keys: ['x'], signals, adjust})];
  if (bounds.length > 0) {
    plots.push(fittedPlot({spec: 'sweep_bounds', heading: positions ? 'Empirical (solid) and estimated (dashed) 2σ' : 'Empirical (full) and estimated (empty) 2σ', rows: bounds, fields: ['value'],
      unit: 'm', title: '2σ of position', keys: ['x', 'kind'], signals, adjust}));
  }
  return inRows(card, plots);
}
