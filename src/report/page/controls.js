// The switches of estimators, the choice of a cell, the axes, the theme; and the first drawing.
function switchEstimator(name, shown) {
  if (shown) state.hidden.delete(name);
  else state.hidden.add(name);
  // The map keeps its zoom.
  const zooms = chartViews.trajectories.map((view) => ['dom_h', 'dom_v'].map((axis) => [axis, view.signal(axis)]));
  charts.forEach(drawChart);
  chartViews.trajectories.forEach((view, i) => {
    for (const [axis, domain] of zooms[i]) view.signal(axis, domain);
    view.run();
  });
}

function makeSwitches() {
  const entries = study.estimators.map((one) => [one.name, one.label]);
  if (study.cells.some((cell) => cell.example.truth)) entries.unshift([kTruth, kTruth]);
  for (const [name, text] of entries) {
    const box = element('input', {type: 'checkbox', checked: true, onchange: () => switchEstimator(name, box.checked)});
    box.dataset.estimator = name;
    document.getElementById('switches').append(element('label', {}, [box, swatch(name), text]));
  }
}

function drawCell() {
  drawVerdict();
  drawTable();
  drawSummary();
  drawPaired();
  drawCharts();
}

function chooseCell(place) {
  state.cell = place;
  document.getElementById('cell').value = String(place);
  drawCell();
}

function makeAxes() {
  const kinds = [['usual', 'as each chart is made'], ['linear', 'linear'], ['log', 'logarithmic']];
  const select = chooser({label: '', key: 'axes', values: kinds}, drawCharts);
  select.querySelector('select').setAttribute('aria-label', 'Axes');
  const box = element('input', {type: 'checkbox', checked: state.baselineOnScale, onchange: () => {
    state.baselineOnScale = box.checked;
    drawCharts();
  }});
  document.getElementById('axes').append(select, element('label', {id: 'baseline-on-scale'}, [box, 'dead reckoning on every scale']));
}

function makeCellChooser() {
  const field = document.getElementById('cells');
  field.hidden = study.cells.length < 2;
  const select = element('select', {id: 'cell', onchange: () => chooseCell(Number(select.value))});
  study.cells.forEach((cell, i) => select.append(element('option', {value: i, textContent: cell.label})));
  select.setAttribute('aria-label', 'Cell');
  field.append(select);
}

function showTheme() {
  document.documentElement.dataset.theme = state.dark ? 'dark' : 'light';
  document.getElementById('theme').textContent = state.dark ? 'Light' : 'Dark';
}

function makeHead() {
  document.getElementById('title').textContent = study.title || document.title;
  const estimators = study.estimators.length - 1;
  const count = (n, noun) => `${n} ${noun}${n === 1 ? '' : 's'}`;
  const alignments = [...new Set(study.cells.map((cell) => cell.alignment))].filter(Boolean);
  document.getElementById('subtitle').textContent = [
    count(estimators, 'estimator'), study.cells.length > 1 ? count(study.cells.length, 'cell') : '',
    `${repeatsOf(study.cells)}${study.cells.length > 1 ? ' each' : ''}`,
    alignments.length > 0 ? `alignment ${alignments.join(', ')}` : ''].filter(Boolean).join(' · ');
  const text = document.getElementById('data').textContent;
  document.getElementById('download').href = URL.createObjectURL(new Blob([text], {type: 'application/json'}));
  document.getElementById('theme').onclick = () => {
    state.dark = !state.dark;
    showTheme();
    drawCharts();
  };
}

makeHead();
document.getElementById('all-metrics').open = study.cells.length === 1;
showTheme();
makeSwitches();
makeCellChooser();
makeAxes();
drawManifest();
watchBoxes();
makeCards();
makeMetricChooser();
makeMosaics();
drawCell();

// Print is on white paper; the widths are those of the window.
let themeBefore = false;
window.addEventListener('beforeprint', () => {
  themeBefore = state.dark;
  state.dark = false;
  showTheme();
  drawCharts();
});
window.addEventListener('afterprint', () => {
  state.dark = themeBefore;
  showTheme();
  drawCharts();
});
let resizing = 0;
let lastWidth = window.innerWidth;
window.addEventListener('resize', () => {
  if (window.innerWidth === lastWidth) return;
  lastWidth = window.innerWidth;
  clearTimeout(resizing);
  resizing = setTimeout(drawCharts, 150);
});
