// report.html#selftest: does what a reader would and writes what became of it into the page.
function marksOf(id, colour) {
  const drawn = document.querySelectorAll(
    `#chart-${id} .role-mark path, #chart-${id} .role-mark line, #chart-${id} .role-mark text`);
  const visible = [...drawn].filter((one) => one.tagName !== 'path' || one.getAttribute('d'));
  if (!colour) return visible.length;
  return visible.filter((one) => [one.getAttribute('fill'), one.getAttribute('stroke')].includes(colour)).length;
}

function marksOfAll(colour) {
  return Object.fromEntries(charts.filter((chart) => !document.getElementById('chart-' + chart.id).hidden)
    .map((chart) => [chart.id, marksOf(chart.id, colour)]));
}

// Vega takes events and draws in later turns, which its views tell the end of.
const drawn = () => Promise.all(Object.values(chartViews).flat().map((view) => view.runAsync()));

// Numbers as the page writes them, by what JavaScript takes them for: ties, and numbers that have a
// digit more once they are rounded.
function digitsTest() {
  const numbers = [0.125, 0.375, 2.5, 1.125, 1.375, 100.5, 101.5, 1234.5, 1235.5, 0.00009996, 0.0001, 9.9951, 9.9949, 999.5, 998.5, 0.5, 1e6, 9999999, -1.125, 1.005];
  return numbers.map((value) => [value, digits(value)]);
}

// Of a number without a unit.
const intervalTest = () => ({text: withInterval({mean: 1.7e6, low: -4.87e4, high: 9.17e6}, ''),
  parts: valueParts('', null, {done: 2}, {value: {mean: 1.7e6, low: -4.87e4, high: 9.17e6, n: 2}}).map((one) => one.textContent)});

const captionsOfAll = () => Object.fromEntries(charts.filter((chart) => !document.getElementById('chart-' + chart.id).hidden)
  .map((chart) => [chart.id, textOf(`#chart-${chart.id} .caption`)[0]]));

// Whether the map's axes are equal, x goes up and y to the left, before and after the wheel was
// turned, the map dragged, and clicked twice.
async function mapTest() {
  const view = (chartViews.trajectories || [])[0];
  if (!view) return null;
  const svg = document.querySelector('#chart-trajectories svg');
  const box = svg.getBoundingClientRect();
  const fire = (type, target, x, y, more = {}) => target.dispatchEvent(new (type === 'wheel' ? WheelEvent : MouseEvent)(
    type, {bubbles: true, cancelable: true, view: window, clientX: box.x + x, clientY: box.y + y, ...more}));
  const look = () => {
    const [h, v] = [view.scale('h'), view.scale('v')];
    return {left: h(0) - h(1), up: v(0) - v(1), middle: [h.invert(100), v.invert(100)]};
  };
  const looks = {start: look()};
  fire('wheel', svg, 300, 200, {deltaY: -300});
  await drawn();
  looks.wheel = look();
  fire('mousedown', svg, 300, 200);
  fire('mousemove', window, 360, 230);
  fire('mouseup', window, 360, 230);
  await drawn();
  looks.drag = look();
  fire('dblclick', svg, 300, 200);
  await drawn();
  looks.end = look();
  return looks;
}

// How the map draws the path of an estimator.
function pathOf(name) {
  const path = [...document.querySelectorAll('#chart-trajectories path')].find(({__data__: item}) =>
    item && item.mark.marktype === 'line' && item.datum && item.datum.label === labelOf(name));
  return path && {dashes: path.getAttribute('stroke-dasharray'), offset: path.getAttribute('stroke-dashoffset'), width: Number(path.getAttribute('stroke-width'))};
}

// The same of all, and without the first one that is compared.
async function turnsTest() {
  const names = study.estimators.slice(1).map((one) => one.name);
  const all = () => names.map(pathOf);
  const box = document.querySelectorAll('#switches input')[2];
  const look = () => ({lines: all(), note: textOf('#chart-trajectories .notes')[0], maps: textOf('#chart-registrations h4')});
  const before = look();
  box.click();
  await drawn();
  const without = look();
  box.click();
  await drawn();
  return [before, without];
}

// What the map shows of absolute measurements: where fixes are (m), the direction of headings on the
// screen, and of each its tooltip and whether it is red.
function absoluteTest() {
  const view = (chartViews.trajectories || [])[0];
  if (!view) return null;
  const [h, v] = [view.scale('h'), view.scale('v')];
  const all = (name) => [...document.querySelectorAll(`#chart-trajectories g.${name} > *`)].map((node) => {
    const [u, w] = node.getAttribute('transform').match(/-?[\d.]+(e-?\d+)?/g).map(Number);
    return {x: v.invert(w), y: h.invert(u), right: Number(node.getAttribute('x2')), down: Number(node.getAttribute('y2')),
      isRing: /A/.test(node.getAttribute('d') || ''), isRed: node.getAttribute('stroke') === css('--left-out'), tooltip: node.__data__.tooltip};
  });
  return {fixes: all('fixes'), headings: all('headings'), links: all('links'), bars: all('bars').length,
    caption: textOf('#chart-trajectories .caption')};
}

const textOf = (selector) => [...document.querySelectorAll(selector)].map((one) => one.textContent);
// Vega leaves labels that would overlap others in the page, unseen.
const seenLabels = (axis) => [...axis.querySelectorAll('.role-axis-label text')].filter((one) => one.getAttribute('opacity') !== '0').map((one) => one.textContent);

// What the page says first, what its table marks, and what the axes become.
async function answerTest() {
  const choose = async (selector, value) => {
    const select = document.querySelector(selector);
    select.value = value;
    select.dispatchEvent(new Event('change'));
    await drawn();
  };
  const scaleTypes = () => Object.fromEntries(['forest', 'keyframes', 'updates', 'pareto']
    .map((id) => [id, (chartViews[id] || []).map((view) => view.scale(id === 'forest' ? 'x' : 'y').type)]));
  // Of an axis that is logarithmic: how far it goes beyond its values, and what is labelled.
  const axisOf = (id, name, field) => {
    const [view] = chartViews[id];
    if (!view) return null;
    const values = view.data('rows').map((row) => row[field]);
    const [low, high] = view.scale(name).domain();
    return {below: Math.min(...values) / low, above: high / Math.max(...values), round: roundValues(low, high).map(String),
      labels: textOf(`#chart-${id} .role-axis-label text`)};
  };
  const result = {
    words: textOf('#verdict > ul:first-child li'), doubts: textOf('#verdict > ul.doubts li'),
    best: document.querySelectorAll('#cells-table td.best').length, header: textOf('#cells-table th'),
    sweep: ['line', 'rule', 'symbol'].map((mark) => document.querySelectorAll(`#chart-sweep .mark-${mark}.role-mark > *`).length),
    ticks: [...document.querySelectorAll('#chart-sweep svg')].map((one) => seenLabels(one.querySelector('.role-axis'))),
    crossed: crossedLabels('sweep'), sweepScales: (chartViews.sweep || []).map((view) => view.scale('x').type), first: textOf('#cells-table tbody tr:first-child td'), notes: textOf('.notes'), usual: scaleTypes(),
    overflow: ['cells-table', 'summary-table'].filter((id) => {
      const box = document.getElementById(id);
      return box.scrollWidth > box.clientWidth;
    }),
  };
  for (const axes of ['linear', 'log', 'usual']) {
    await choose('#axes select', axes);
    result[axes] = scaleTypes();
    if (axes === 'log') result.axis = axisOf('updates', 'y', 'value');
  }
  document.querySelector('#baseline-on-scale input').click();
  await drawn();
  result.notesOnScale = textOf('.notes');
  document.querySelector('#baseline-on-scale input').click();
  await choose('#cells-metric select', 'total_ms');
  result.other = {title: textOf('#cells-title')[0], header: textOf('#cells-table th'), forest: marksOf('forest')};
  return result;
}

// How much of its box a table takes, and what is seen of it in a box as narrow as a telephone's.
function tableTest(id) {
  const box = document.getElementById(id);
  const share = box.firstChild.offsetWidth / box.clientWidth;
  const hint = () => getComputedStyle(box, '::before').content;
  const wide = {hint: hint(), tabIndex: box.tabIndex};
  box.style.width = '260px';
  markScrolling(box);
  box.scrollLeft = box.clientWidth;
  const name = box.querySelector('tbody td').getBoundingClientRect().left - box.getBoundingClientRect().left;
  const cut = [...box.querySelectorAll('tbody tr:first-child td:not(:first-child)')].filter((cell) => {
    const [own, outer] = [cell, box].map((one) => one.getBoundingClientRect());
    return own.left < outer.right - 1 && own.right > outer.right + 1;
  }).length;
  const narrow = {hint: hint(), tabIndex: box.tabIndex, scrolled: box.scrollLeft, name, cut};
  Object.assign(box.style, {width: '', height: '60px', overflowY: 'auto'});
  markScrolling(box);
  const low = {hint: getComputedStyle(box, '::after').content, tabIndex: box.tabIndex};
  Object.assign(box.style, {height: '', overflowY: ''});
  markScrolling(box);
  return {share, wide, narrow, low};
}

// The mosaics shown: of each choice the width of the picture once it is loaded, what is drawn over
// it, and the caption.
async function mosaicTest() {
  const shown = async (id) => {
    const card = document.getElementById(id);
    const image = card.querySelector('img');
    if (card.hidden || !image) return null;
    // Not decode(): the browser's virtual time waits for what is loaded, not for its decoder.
    if (!image.complete) await new Promise((loaded) => image.addEventListener('load', loaded, {once: true}));
    return {width: image.naturalWidth, lines: card.querySelectorAll('polyline').length, caption: card.querySelector('.caption').textContent};
  };
  const all = async (id) => {
    const looks = [await shown(id)];
    const select = document.querySelector(`#${id} select`);
    for (const option of select ? [...select.options].slice(1) : []) {
      select.value = option.value;
      select.dispatchEvent(new Event('change'));
      looks.push(await shown(id));
    }
    return looks;
  };
  const result = {hidden: document.getElementById('mosaics').hidden, estimate: await all('mosaic-estimate')};
  for (const box of document.querySelectorAll('#mosaic-estimate input')) box.click();
  result.bare = await shown('mosaic-estimate');
  result.difference = await all('mosaic-difference');
  return result;
}

async function selfTest() {
  await drawn();
  const result = {marks: marksOfAll(), absolute: absoluteTest(), estimators: {}, cells: [], tables: {}, digits: digitsTest(), interval: intervalTest(), captions: captionsOfAll(), cut: cutTest()};
  for (const box of document.querySelectorAll('#switches input')) {
    const style = styleOf(box.dataset.estimator);
    if (!style) continue;
    const before = marksOfAll(style.colour);
    box.click();
    await drawn();
    const off = marksOfAll(style.colour);
    box.click();
    await drawn();
    result.estimators[style.name] = {before, off, again: marksOfAll(style.colour)};
  }
  result.layers = [marksOf('trajectories')];
  for (const box of document.querySelectorAll('#chart-trajectories .choices input')) {
    box.click();
    await drawn();
    result.layers.push(marksOf('trajectories'));
    box.click();
    await drawn();
  }
  result.map = await mapTest();
  const select = document.getElementById('cell');
  for (let i = 0; i < study.cells.length; ++i) {
    select.value = String(i);
    select.dispatchEvent(new Event('change'));
    await drawn();
    result.cells.push(marksOfAll());
  }
  result.answer = await answerTest();
  const bar = document.getElementById('controls');
  result.bar = {cut: bar.scrollWidth - bar.clientWidth, position: getComputedStyle(bar).position};
  result.beyond = document.documentElement.scrollWidth - window.innerWidth;
  result.turns = await turnsTest();
  result.mosaics = await mosaicTest();
  document.getElementById('all-metrics').open = true;
  result.boxes = [tableTest('cells-table'), tableTest('summary-table')];
  for (const folded of document.querySelectorAll('details')) folded.open = true;
  result.access = [accessTest()];
  document.getElementById('theme').click();
  await drawn();
  result.access.push(accessTest());
  result.theme = document.documentElement.dataset.theme;
  for (const part of ['cells-table', 'summary-table', 'paired-table', 'manifest']) {
    result.tables[part] = document.querySelectorAll(`#${part} tr`).length;
  }
  result.errors = pageErrors;
  document.body.append(element('pre', {id: 'selftest', textContent: JSON.stringify(result)}));
}

if (location.hash === '#selftest') selfTest();
