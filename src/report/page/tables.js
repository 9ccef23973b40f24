// The summary, the paired tests and the manifests, as tables.
function tableOf(header, rows) {
  const cellOf = (tag) => (content) => {
    const cell = element(tag);
    if (typeof content === 'string') cell.textContent = content;
    else if (content) cell.append(...[content].flat());
    return cell;
  };
  return element('table', {}, [
    element('thead', {}, [element('tr', {}, header.map(cellOf('th')))]),
    element('tbody', {}, rows.map((row) => element('tr', {}, row.map(cellOf('td')))))]);
}

// A table into its box, which the keyboard reaches and which says so where it scrolls.
function fillBox(id, table) {
  const box = document.getElementById(id);
  box.replaceChildren(table);
  markScrolling(box);
}

function markScrolling(box) {
  for (const name of ['--first', '--column']) box.style.removeProperty(name);
  const isSideways = box.scrollWidth > box.clientWidth;
  box.classList.toggle('sideways', isSideways);
  if (isSideways && box.classList.contains('alike')) showWholeColumns(box);
  const isDownwards = box.scrollHeight > box.clientHeight;
  box.classList.toggle('downwards', isDownwards);
  if (isSideways || isDownwards) box.tabIndex = 0;
  else box.removeAttribute('tabindex');
}

// As many columns beside the names of rows as fit have all the room, so that none is cut.
function showWholeColumns(box) {
  const [first, ...others] = [...box.querySelector('tr').cells].map((cell) => cell.offsetWidth);
  const room = box.clientWidth - first;
  const widest = Math.max(1, ...others);
  const column = Math.max(widest, Math.floor(room / Math.max(1, Math.floor(room / widest))));
  for (const [name, width] of [['--first', first], ['--column', column]]) box.style.setProperty(name, `${width}px`);
}

// A box is also measured when it is unfolded or the window changes.
function watchBoxes() {
  // In the next frame: what is marked changes the size of the box.
  const observer = new ResizeObserver((entries) => requestAnimationFrame(() => entries.forEach((entry) => markScrolling(entry.target))));
  for (const box of document.querySelectorAll('.scroll')) observer.observe(box);
}

// A zero-width space behind each underscore.
const breakable = (name) => name.replaceAll('_', '_\u200b');

// The line by which charts draw an estimator.
function swatch(name) {
  const style = styleOf(name);
  const mark = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  mark.setAttribute('class', 'swatch');
  const line = document.createElementNS('http://www.w3.org/2000/svg', 'line');
  const dashes = style ? dashesOf(style).join(' ') : '';
  for (const [key, value] of Object.entries({x1: 0, y1: 2, x2: 30, y2: 2, 'stroke-width': 3,
    stroke: style ? style.colour : 'currentColor', 'stroke-dasharray': dashes})) {
    line.setAttribute(key, value);
  }
  mark.append(line);
  return mark;
}

// A mean in the unit that it shares, or with its own, which is said where it is not the header's, and
// below it its interval and its n where that is not all.
function valueParts(metric, shared, one, {value = one.metrics[metric], header = shared} = {}) {
  const scale = shared || unitWithInterval(value, metric);
  const said = !header ? scale.text : header.text === scale.text ? '' : scale.text || '× 1';
  const parts = [element('span', {textContent: followedBy(numberIn(value.mean, scale), said)})];
  if (value.low !== undefined) {
    parts.push(element('span', {className: 'interval', textContent: followedBy(rangeOf(value, scale), isPower(said) ? said : '')}));
  }
  if (value.n < one.done) parts.push(element('span', {className: 'interval', textContent: `n = ${value.n}`}));
  return parts;
}

// Of a narrow window the first columns are seen.
const baselineLast = (estimators) => [...estimators.filter((one) => one.name !== kBaseline), ...estimators.filter((one) => one.name === kBaseline)];

function drawSummary() {
  const cell = cellNow();
  const estimators = baselineLast(cell.estimators);
  const metrics = study.study_metrics.filter((name) => cell.estimators.some((one) => one.metrics[name]));
  const scaleOf = (metric, isBaseline) => sharedUnit(unitOf(metric), cell.estimators
    .filter((one) => one.metrics[metric] && (one.name === kBaseline) === isBaseline).map((one) => one.metrics[metric].mean));
  // Dead reckoning may be of another size.
  const cellOf = (one, metric, scale) => {
    if (!one.metrics[metric]) return '–';
    return valueParts(metric, scale && one.name === kBaseline ? scaleOf(metric, true) : scale, one, {header: scale});
  };
  const rows = metrics.map((metric) => {
    const scale = scaleOf(metric, false);
    return [titled(metricTitle(metric), scale ? scale.text : ''), ...estimators.map((one) => cellOf(one, metric, scale))];
  });
  const outcomes = estimators.map((one) => (one.name === kBaseline ? '–' : one.outcome_text));
  const made = tableOf(['', ...estimators.map((one) => [swatch(one.name), breakable(labelOf(one.name))])], [['outcome', ...outcomes], ...rows]);
  estimators.forEach((one, i) => {
    made.tBodies[0].rows[0].cells[i + 1].className = 'wrapped' + (one.done < one.runs ? ' failed' : '');
  });
  document.getElementById('summary-title').textContent = study.cells.length > 1 ? `All metrics of ${cell.label}` : 'All metrics';
  fillBox('summary-table', made);
  document.getElementById('summary-words').replaceChildren(...cell.estimators.filter((one) => one.words.length > 0)
    .map((one) => element('li', {textContent: `${labelOf(one.name)}: ${one.words.join(' ')}`})));
  document.getElementById('summary-caption').textContent = `${sentence(conditions(cell))}. ` +
    (cell.n > 1 ? study.intervals : 'A single trial: values without intervals.') + (cell.limits ? ` ${cell.limits}` : '') +
    (metrics.some((name) => study.metrics[name].cost) ? ` Cost: ${jobsNote(cell)}` : '');
}

function drawPaired() {
  const tests = cellNow().paired.filter((one) => one.n > 1);
  const first = study.estimators.length > 1 ? study.estimators[1].label : '';
  document.getElementById('paired').hidden = tests.length === 0;
  document.getElementById('paired-title').textContent = `Paired tests: differences to ${first} (${tests.length})`;
  document.getElementById('paired-caption').textContent =
    `The estimator minus ${first}, ${tests.some((one) => one.over === 'surveys') ? 'over the surveys’ mean differences of the trials' : 'over the trials'} that both did: ` +
    'mean with its 95 % interval, Wilcoxon’s signed-rank test, and its p-value adjusted after Holm over the tests of this table.' +
    (cellNow().limits ? ` ${cellNow().limits}` : '');
  const rows = tests.map((one) => [
    [swatch(one.estimator), breakable(labelOf(one.estimator))], metricTitle(one.metric),
    valueParts(one.metric, null, {done: one.n}, {value: one}), digits(one.p), digits(one.holm_p), `${one.n} ${one.over}`]);
  const made = tableOf(['estimator', 'metric', 'mean difference', 'p', 'p (Holm)', 'pairs'], rows);
  for (const row of made.rows) row.cells[1].className = 'text';
  fillBox('paired-table', made);
}

// Nested objects as dotted keys.
function flat(value, prefix = '') {
  if (value === null || typeof value !== 'object') return [[prefix, String(value)]];
  return Object.entries(value).flatMap(([key, inner]) => flat(inner, prefix ? `${prefix}.${key}` : key));
}

function drawManifest() {
  const part = (title, rows, open) => element('details', {open}, [
    element('summary', {textContent: title}), element('div', {className: 'scroll'}, [tableOf(['key', 'value'], rows)])]);
  const sessions = study.manifests.map((manifest, i) => {
    const rows = flat(manifest).filter(([key]) => !key.startsWith('configuration.'));
    return part(study.manifests.length > 1 ? `Session ${i + 1}` : 'Session', rows, i === 0);
  });
  const configuration = Object.entries(study.configuration);
  document.getElementById('manifest').append(...sessions,
    part(`Configuration (${configuration.length} keys)`, configuration, false));
}
