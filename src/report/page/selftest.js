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

// Vega draws after the turn in which it was asked to.
const drawn = () => new Promise((resolve) => setTimeout(resolve, 20));

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
