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

async function selfTest() {
  await drawn();
  const result = {marks: marksOfAll(), estimators: {}, cells: [], tables: {}};
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
  document.getElementById('theme').click();
  await drawn();
  result.theme = document.documentElement.dataset.theme;
  for (const part of ['summary-table', 'paired-table', 'manifest']) {
    result.tables[part] = document.querySelectorAll(`#${part} tr`).length;
  }
  result.errors = pageErrors;
  document.body.append(element('pre', {id: 'selftest', textContent: JSON.stringify(result)}));
}

if (location.hash === '#selftest') selfTest();
