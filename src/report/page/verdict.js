// The answer in words, and the table of cells by estimators for one metric.
const listOf = (sentences, className = '') =>
  element('ul', {className}, sentences.map((text) => element('li', {textContent: text})));

function verdictParts({answer, cost, failed, doubts}) {
  const parts = [listOf([...answer, ...cost])];
  if (failed.length > 0) parts.push(element('h4', {textContent: 'What failed'}), listOf(failed, 'failed'));
  if (doubts.length > 0) parts.push(element('h4', {textContent: 'What makes it doubtful'}), listOf(doubts, 'doubts'));
  return parts;
}

function drawVerdict() {
  const parts = verdictParts(study.verdict);
  if (study.verdict.rule) parts.push(element('p', {className: 'caption', textContent: study.verdict.rule}));
  document.getElementById('verdict').replaceChildren(...parts);
  if (study.cells.length < 2) return;
  const {label, verdict} = cellNow();
  const doubts = verdict.doubts.filter((text) => !study.verdict.doubts.includes(text));
  document.getElementById('cell-verdict').replaceChildren(element('details', {open: true}, [
    element('summary', {textContent: `In the cell ${label}`}), ...verdictParts({...verdict, doubts})]));
}

// One unit for each column, so that its values can be compared; one for all estimators.
function columnUnits(names) {
  const meansOf = (wanted) => study.cells.flatMap((cell) => cell.estimators
    .filter((one) => wanted(one.name) && one.metrics[state.metric]).map((one) => one.metrics[state.metric].mean));
  const unit = unitOf(state.metric);
  // The middle one: cells may be of very different sizes.
  const middleOf = (values) => values.map(Math.abs).sort((a, b) => a - b)[Math.floor(values.length / 2)] || 0;
  const unitFor = (values) => sharedUnit(unit, values, middleOf(values));
  const estimators = unitFor(meansOf((name) => name !== kBaseline));
  const baseline = unitFor(meansOf((name) => name === kBaseline));
  return names.map((name) => (name === kBaseline ? baseline : estimators));
}

// The mean, its interval below, and what it is beside the best of its row.
function standingCell(cell, name, scale) {
  const one = cell.estimators.find((other) => other.name === name);
  const metric = one && one.metrics[state.metric];
  const failed = one ? one.runs - one.done : 0;
  const parts = metric ? valueParts(state.metric, scale, one, {value: rankedOf(metric)}) : ['–'];
  const standing = standingOf(cell.rankings[state.metric], name);
  if (standing === 'best') parts.unshift(element('span', {className: 'mark', title: 'the best', textContent: '★ '}));
  if (standing === 'equivalent') parts.unshift(element('span', {className: 'mark', title: 'equivalent to the best', textContent: '≈ '}));
  if (standing === 'worse') parts.unshift(element('span', {className: 'mark', title: 'worse than the best', textContent: '▽ '}));
  if (failed > 0) parts.push(element('span', {className: 'interval failed', textContent: `${failed} failed`}));
  return {parts, standing};
}

function drawTable() {
  const names = baselineLast(study.estimators).map((one) => one.name)
    .filter((name) => study.cells.some((cell) => cell.estimators.some((one) => one.name === name && one.metrics[state.metric])));
  const units = columnUnits(names);
  const several = study.cells.length > 1;
  const standings = study.cells.map((cell) => names.map((name, i) => standingCell(cell, name, units[i])));
  const rows = study.cells.map((cell, i) => [
    several ? element('button', {className: 'link', textContent: cell.label, onclick: () => chooseCell(i)}) : metricTitle(state.metric),
    ...standings[i].map((one) => one.parts)]);
  const header = [several ? 'cell' : 'metric', ...names.map((name, i) => [swatch(name), titled(breakable(labelOf(name)), units[i] ? units[i].text : '')])];
  const made = tableOf(header, rows);
  standings.forEach((row, i) => {
    const drawnRow = made.tBodies[0].rows[i];
    if (several && i === state.cell) drawnRow.className = 'chosen';
    row.forEach((one, column) => { drawnRow.cells[column + 1].className = one.standing; });
  });
  document.getElementById('cells-title').textContent = several
    ? `${sentence(metricTitle(state.metric))} in every cell` : sentence(metricTitle(state.metric));
  const ranked = study.cells.some((cell) => cell.rankings[state.metric]);
  const {better} = study.metrics[state.metric] || {};
  const marks = ranked ? `★ best mean${several ? ' of the row' : ''} (${better} is better), ≈ equivalent to it, ▽ worse; the others are not shown to differ. ` +
    'An estimator that failed a run, or has no value where others have one, is not ranked.'
    : `This metric is not ranked${better === 'neither' ? ': no value of it is the better one' : unranked(state.metric) && `: ${unranked(state.metric)}`}.`;
  document.getElementById('cells-caption').textContent =
    `${study.cells.some((cell) => cell.n > 1) ? 'Means with 95 % intervals' : 'Values of one trial'}, ${repeatsOf(study.cells)}${several ? ' a cell' : ''}. ${marks}`;
  fillBox('cells-table', made);
}

// The metric of the first chart and of the table is one choice, with a control at both.
function makeMetricChooser() {
  const values = metricChoices().map((name) => [name, metricTitle(name)]);
  const redraw = () => {
    for (const select of document.querySelectorAll('select.metric')) select.value = state.metric;
    drawChart(charts.find((chart) => chart.id === 'forest'));
    drawTable();
  };
  const places = [document.querySelector('#chart-forest .choices'), document.getElementById('cells-metric')];
  for (const place of places) {
    const label = chooser({label: 'metric', key: 'metric', values}, redraw);
    label.querySelector('select').className = 'metric';
    place.append(label);
  }
}
