// The charts as cards: each has a title, a caption, its own choices, and its plots.
const metricChoices = (cost) => Object.keys(study.metrics).filter((name) => cost === undefined || study.metrics[name].cost === cost);
const exampleNote = () => sentence(cellNow().example.text);

const charts = [
  {id: 'forest', title: 'Means', host: 'answer-chart', plots: forestPlots,
    exists: (cell) => cell.estimators.some((one) => one.metrics[state.metric]),
    caption: (cell) => {
      const intervals = cell.n > 1 ? 'Mean with its 95 % interval. ' : 'The values of one trial. ';
      const marks = cell.n > 1 && cell.rankings[state.metric] ? ' Dashed line: the best. Hollow: worse.' : '';
      return `${intervals}${sentence(conditions(cell))}.${marks}`;
    }},
  {id: 'trajectories', title: 'Trajectories', wide: () => !mapIsTall(), plots: trajectoryPlots,
    choices: () => [{label: '2σ ellipses', signal: 'show_ellipses'}, {label: 'loops', signal: 'show_loops'},
      ...(study.cells.some(hasMarks) ? [{label: 'fixes and headings', signal: 'show_marks'}] : [])],
    exists: (cell) => cell.example.truth !== null || cell.example.estimators.some((one) => one.path),
    caption: (cell) => `${exampleNote()}; ${conditions(cell)}. x up, y to the left. ` +
      'Thin lines: loops used; dashed with ×: rejected, with △: lost; ellipses: 2σ. ' +
      (cell.example.estimators.some(thinnedNote) ? 'Loops are thinned evenly. ' : '') + marksCaption(cell) +
      'Wheel: zoom, drag: move, double click: all.'},
  {id: 'pareto', title: 'Accuracy against cost', plots: paretoPlots,
    exists: (cell) => cell.estimators.some(({metrics}) => [true, false].every((cost) =>
      Object.keys(metrics).some((name) => study.metrics[name].cost === cost && (!cost || metrics[name].mean > 0)))),
    choices: () => [
      {label: 'accuracy', key: 'accuracy', values: metricChoices(false).map((name) => [name, metricTitle(name)])},
      {label: 'cost', key: 'cost', values: metricChoices(true).map((name) => [name, metricTitle(name)])}],
    caption: (cell) => {
      if (paretoRows(cell).rows.length === 0) return 'No estimator of this cell has a value of both.';
      const {better} = study.metrics[state.accuracy];
      const against = unrankedIn(cell, state.accuracy);
      const front = better === 'neither' ? 'No value of this metric is the better one, so none is ringed.'
        : against ? `None is ringed: ${against}.`
        : `Ringed, on the dashed line: no other that is compared is both better (${better}) and cheaper.`;
      return `${sentence(conditions(cell))}. Means with 95 % intervals. ${front} Grey line: dead reckoning. ${jobsNote(cell)}`;
    }},
  {id: 'updates', title: 'Cost of an update', plots: updatePlots,
    exists: (cell) => sum(cell.estimators.map((one) => one.updates.keyframe.length)) > 0,
    caption: (cell) => `${sentence(conditions(cell))}. Median over trials. No line crosses keyframes without an update. ${jobsNote(cell)}`},
  {id: 'sweep', title: 'Error against the sweep', wide: true, plots: sweepPlots,
    exists: () => study.axes.some((axis) => axis.labels.length > 1),
    choices: () => [
      {label: 'axis', key: 'axis', values: study.axes.map((axis, i) => [i, axis.title]).filter(([i]) => study.axes[i].labels.length > 1)},
      {label: 'metric', key: 'sweepMetric', values: metricChoices().map((name) => [name, metricTitle(name)])}],
    caption: (cell) => {
      const fixed = study.axes.map((axis, i) => (i === state.axis ? '' : axis.texts[cell.places[i]]));
      const notSwept = (key, value) => (study.axes[state.axis].key === key ? '' : value);
      const association = notSwept('association.mode', cell.association);
      const alignment = notSwept('evaluation.alignment', cell.alignment);
      const jobs = study.metrics[state.sweepMetric].cost ? ' ' + jobsNote(cell) : '';
      const parts = [...fixed, alignment && `alignment ${alignment}`,
        association && `association ${association}`, `${repeatsOf(sweepCells())} a point`];
      return sentence(parts.filter(Boolean).join(', ')) + failuresOf(sweepCells()) +
        '. Band: mean ± 2 standard deviations over trials. Second plot: twice the root mean square position error, ' +
        'and the mean of 2·√(Pxx + Pyy) that the estimator states; an honest one has them equal.' + jobs;
    }},
  {id: 'regimes', title: 'Regime map', wide: true, plots: regimePlots,
    exists: () => study.regimes !== undefined,
    choices: () => [{label: 'metric', key: 'regimeMetric', values: metricChoices().map((name) => [name, metricTitle(name)])}],
    caption: (cell) => {
      const {across, up, cheapest} = study.regimes;
      const fixed = study.axes.map((axis, i) => (i === across || i === up || axis.labels.length < 2 ? '' : `${axis.texts[cell.places[i]]}, `));
      const relative = regimeIsRelative();
      const meaning = relative ? `${sentence(meanTitle(state.regimeMetric))} over that of the best estimator at the same place: 1 is the best, ten times is dark.`
        : `${sentence(meanTitle(state.regimeMetric))}.` + (unranked(state.regimeMetric) ? ` No best one is shown: ${unranked(state.regimeMetric)}.` : '');
      const choice = cheapest ? ` Last map: by ${meanTitle(cheapest.cost)} the cheapest of those whose ` +
        `${meanTitle(cheapest.metric)} is at most 5 % above the best; ?: others of them are not shown to be dearer, as the tooltip says.` : '';
      return `${fixed.join('')}${repeatsOf(regimeCells())} a square. ${meaning} An estimator that failed a trial, or has no value where others have one, is in no comparison.${choice}`;
    }},
  {id: 'keyframes', title: 'Error and consistency over keyframes', wide: true, plots: keyframePlots,
    exists: (cell) => sum(cell.estimators.map((one) => one.keyframes.keyframe.length)) > 0,
    caption: (cell) => `${sentence(conditions(cell))}. NEES / 3 of an honest estimator is 1; ` +
      'the grey band holds 95 % of its means over independent draws at one keyframe. Above: overconfident.'},
  {id: 'outcomes', title: 'Outcomes', plots: outcomePlots,
    exists: (cell) => cell.estimators.some((one) => Object.keys(one.outcomes).length > 0),
    caption: (cell) => `${sentence(conditions(cell))}. ` +
      `Trials by how their run ended. Converged and iteration limit count as done; all means are over those.`},
  {id: 'registrations', title: 'Registration map', wide: () => registrationPictures().length > 1, plots: registrationPlots,
    exists: (cell) => cell.example.estimators.some((one) => one.loops.length > 0),
    caption: (cell) => `${exampleNote()}; ${conditions(cell)}. ` +
      `Keyframe by keyframe: filled square used, × rejected by the gate, △ lost with a failed update. Estimators with the same outcome share a map.`},
];

// Those that stand two in a row; one without a neighbour takes the row.
function layOut() {
  for (const chart of charts) document.getElementById('chart-' + chart.id).hidden = !chart.exists(cellNow());
  for (const chart of charts.filter((one) => typeof one.wide === 'function')) {
    document.getElementById('chart-' + chart.id).classList.toggle('wide', chart.wide());
  }
  const cards = charts.filter((chart) => !chart.host).map((chart) => document.getElementById('chart-' + chart.id)).filter((card) => !card.hidden);
  let left = null;
  for (const card of cards) {
    card.classList.remove('alone');
    const isWide = card.classList.contains('wide');
    if (isWide && left) left.classList.add('alone');
    left = isWide || left ? null : card;
  }
  if (left) left.classList.add('alone');
}

const chartViews = {};

// A switch within a chart; it leaves the zoom as it is.
function signalSwitch({label, signal}, chart) {
  const box = element('input', {type: 'checkbox', checked: state[signal], onchange: () => {
    state[signal] = box.checked;
    for (const view of chartViews[chart.id]) view.signal(signal, box.checked).run();
  }});
  return element('label', {}, [box, label]);
}

function chooser(choice, redraw) {
  const select = element('select', {onchange: () => {
    state[choice.key] = typeof state[choice.key] === 'number' ? Number(select.value) : select.value;
    redraw();
  }});
  for (const [value, text] of choice.values) {
    select.append(element('option', {value, textContent: text, selected: value === state[choice.key]}));
  }
  return element('label', {textContent: choice.label + ' '}, [select]);
}

function drawChart(chart) {
  const card = document.getElementById('chart-' + chart.id);
  const exists = !card.hidden;
  for (const view of chartViews[chart.id] || []) view.finalize();
  chartViews[chart.id] = [];
  const plots = card.querySelector('.plots');
  plots.replaceChildren();
  if (!exists) return;
  card.querySelector('.caption').textContent = chart.caption(cellNow());
  const drawn = chart.plots(card);
  card.querySelector('.notes').textContent = notesOf(drawn);
  for (const plot of drawn) {
    const container = element('div');
    const place = element('div', {className: 'plot'}, [
      ...(plot.heading ? [element('h4', {textContent: plot.heading})] : []), container]);
    if (plot.width) place.style.width = `${plot.width + (plot.spec === 'registrations' ? 75 : 0)}px`;
    plots.append(place);
    chartViews[chart.id].push(drawPlot(container, plot.spec, plot));
  }
}

function makeCards() {
  for (const chart of charts) {
    const choices = chart.choices && chart.exists(cellNow()) ? chart.choices().filter((choice) => choice.signal || choice.values.length > 1) : [];
    document.getElementById(chart.host || 'charts').append(element('article', {id: 'chart-' + chart.id, className: 'card' + (chart.wide === true ? ' wide' : '')}, [
      element('div', {className: 'card-head'}, [
        element('h3', {textContent: chart.title}),
        element('div', {className: 'choices'}, choices.map((choice) =>
          choice.signal ? signalSwitch(choice, chart) : chooser(choice, () => drawChart(chart))))]),
      element('p', {className: 'caption'}),
      element('div', {className: 'plots'}),
      element('p', {className: 'caption notes'})]));
  }
}

function drawCharts() {
  layOut();
  charts.forEach(drawChart);
}
