// The switches of estimators, the choice of a cell, the theme; and the first drawing of all.
function switchEstimator(name, shown) {
  if (shown) state.hidden.delete(name);
  else state.hidden.add(name);
  // The others keep their zoom: only these are made of what is shown.
  for (const chart of charts) {
    if (chart.id === 'pareto' || chart.id === 'registrations') drawChart(chart);
    else for (const view of chartViews[chart.id]) view.signal('hidden', [...state.hidden]).run();
  }
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
  drawSummary();
  drawPaired();
  drawCharts();
}

function makeCellChooser() {
  const field = document.getElementById('cells');
  field.hidden = study.cells.length < 2;
  const select = element('select', {id: 'cell', onchange: () => {
    state.cell = Number(select.value);
    drawCell();
  }});
  study.cells.forEach((cell, i) => select.append(element('option', {value: i, textContent: cell.label})));
  select.setAttribute('aria-label', 'Cell');
  field.append(select);
}

function showTheme() {
  document.documentElement.dataset.theme = state.dark ? 'dark' : 'light';
  document.getElementById('theme').textContent = state.dark ? 'Light' : 'Dark';
}

function makeHead() {
  document.getElementById('title').textContent = study.title || 'Study';
  const estimators = study.estimators.length - 1;
  const count = (n, noun) => `${n} ${noun}${n === 1 ? '' : 's'}`;
  const alignments = [...new Set(study.cells.map((cell) => cell.alignment))].filter(Boolean);
  document.getElementById('subtitle').textContent = [
    count(estimators, 'estimator'), count(study.cells.length, 'cell'),
    `${repeatsOf(study.cells)} each`,
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
// A long table is not to stand between the summary and the charts.
document.getElementById('paired').open = cellNow().paired.length <= 12;
showTheme();
makeSwitches();
makeCellChooser();
drawManifest();
makeCards();
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
