// What the page shows: the study's data and the reader's choices, and small helpers for both.
const study = JSON.parse(document.getElementById('data').textContent);
const specs = JSON.parse(document.getElementById('specs').textContent);
const kTruth = 'ground truth';
const kBaseline = study.estimators[0].name;  // dead reckoning

const state = {
  hidden: new Set(),
  axes: 'usual',  // linear or logarithmic as each chart is made, or all 'linear' or 'log'
  baselineOnScale: false,  // also where it hides the rest
  metric: study.verdict.metric || study.first.accuracy,  // of the first chart and the table
  cell: 0,  // place in study.cells
  // The longest one: levels of noise rather than a pair of modes.
  axis: study.axes.reduce((best, axis, i) => (axis.labels.length > study.axes[best].labels.length ? i : best), 0),
  sweepMetric: study.first.accuracy,
  regimeMetric: study.first.accuracy,
  accuracy: study.first.accuracy,
  cost: study.first.cost,
  show_ellipses: true,
  show_loops: true,
  show_marks: true,
  dark: window.matchMedia('(prefers-color-scheme: dark)').matches,
};

const cellNow = () => study.cells[state.cell];
const styleOf = (name) => study.estimators.find((one) => one.name === name);
const labelOf = (name) => (styleOf(name) ? styleOf(name).label : name);
const unitOf = (name) => (study.metrics[name] ? study.metrics[name].unit : '');
const metricTitle = (name) => (study.metrics[name] ? study.metrics[name].title : name);
// Why estimators of a cell, or of any, are not ranked by a metric; empty where they are.
const unrankedIn = (cell, name) => cell.unranked[name] || '';
const unranked = (name) => study.cells.map((cell) => unrankedIn(cell, name)).find(Boolean) || '';
const namesOf = (names) => (names.length < 2 ? names.join('') : `${names.slice(0, -1).join(', ')} and ${names[names.length - 1]}`);

function element(tag, properties = {}, children = []) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

// Everything but the estimator that a number depends on, for the caption of every chart.
function conditions(cell) {
  const parts = [];
  if (study.cells.length > 1) parts.push(cell.label);
  if (cell.alignment) parts.push(`alignment ${cell.alignment}`);
  if (cell.association) parts.push(`association ${cell.association}`);
  if (cell.selected_by) parts.push(`loops selected by ${cell.selected_by}`);
  parts.push(cell.repeats);
  return parts.join(', ') + failuresOf([cell]);
}

// "10 surveys × 10 trials": all that occur among some cells.
const repeatsOf = (cells) => [...new Set(cells.map((cell) => cell.repeats))].join(' or ');
const sentence = (text) => text.charAt(0).toUpperCase() + text.slice(1);

// What a mean over these cells leaves out.
function failuresOf(cells) {
  const failed = study.estimators.map(({name, label}) => {
    const runs = cells.flatMap((cell) => cell.estimators.filter((one) => one.name === name));
    const count = runs.reduce((sum, one) => sum + one.runs - one.done, 0);
    return count > 0 ? `${label} ${count} of ${runs.reduce((sum, one) => sum + one.runs, 0)}` : '';
  }).filter(Boolean);
  return failed.length > 0 ? `; failed and in no mean: ${failed.join(', ')}` : '';
}

function jobsNote(cell) {
  if (!cell.jobs) return '';
  const alone = cell.jobs === '1';
  return `Measured with ${cell.jobs} job${alone ? '' : 's'} at a time` +
    (alone ? '.' : '; comparable at 1 job alone.');
}
