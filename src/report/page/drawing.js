// One plot: a specification of page/charts, the theme, the rows and the page's colours, by Vega.
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function themeConfig() {
  const font = getComputedStyle(document.body).fontFamily;
  const ink = css('--ink');
  return {
    background: null,
    axis: {
      domainColor: css('--soft'), tickColor: css('--soft'), gridColor: css('--grid'), labelColor: css('--soft'),
      titleColor: ink, labelFont: font, titleFont: font, labelFontSize: 12, titleFontSize: 12.5,
      titleFontWeight: 500, labelOverlap: true, titlePadding: 8,
    },
    text: {font, fill: ink},
  };
}

// The dashes of a line, of points as in print, in pixels.
const dashesOf = (style) => style.dashes.map((length) => 1.6 * length);

// Of lines that cross, the first estimator's is a little broader, and the lowest.
const kBroadest = 4;
const kThinnest = 1.8;
function thicknessOf(name) {
  const compared = study.estimators.filter((one) => one.name !== kBaseline).map((one) => one.name);
  const place = compared.indexOf(name);
  if (place < 0) return kThinnest;
  const step = Math.min(0.5, (kBroadest - kThinnest) / Math.max(1, compared.length - 1));
  return kThinnest + step * (compared.length - 1 - place);
}

// Lines that lie on one another are as one line on which their colours take turns: the first is
// whole, and each other has its turn on top of it.
const kTurn = 9;
const kShared = kThinnest + 0.6;  // thickness
function turnOf(name, groups) {
  const group = groups.find((one) => one.includes(name));
  const place = group ? group.indexOf(name) : 0;
  if (place === 0) return {dashes: group ? [] : null, offset: 0};
  return {dashes: [kTurn, kTurn * (group.length - 1)], offset: -kTurn * place};
}

// The scales by which all charts colour, dash and mark, whatever is shown.
function sharedScales(groups) {
  const names = [kTruth, ...study.estimators.map((one) => one.name)];
  const turns = study.estimators.map((one) => turnOf(one.name, groups));
  return [
    {name: 'colour', type: 'ordinal', domain: names, range: [css('--ink'), ...study.estimators.map((one) => one.colour)]},
    {name: 'thickness', type: 'ordinal', domain: names, range: [kBroadest + 1.8, ...study.estimators.map((one, i) => (turns[i].dashes ? kShared : thicknessOf(one.name)))]},
    {name: 'dash', type: 'ordinal', domain: names, range: [[], ...study.estimators.map((one, i) => turns[i].dashes || dashesOf(one))]},
    {name: 'shape', type: 'ordinal', domain: names, range: ['circle', ...study.estimators.map((one) => one.mark)]},
    {name: 'offset', type: 'ordinal', domain: names, range: [0, ...turns.map((turn) => turn.offset)]},
  ];
}

function drawPlot(container, specName, {data, width, height, signals = {}, adjust, turns = []}) {
  const spec = structuredClone(specs[specName]);
  spec.scales.push(...sharedScales(turns));
  spec.signals.push({name: 'ink', value: css('--ink')}, {name: 'card', value: css('--card')}, {name: 'left_out', value: css('--left-out')});
  for (const set of spec.data) set.values = data[set.name] || [];
  for (const [name, value] of Object.entries({...signals, hidden: [...state.hidden]})) {
    spec.signals.find((signal) => signal.name === name).value = value;
  }
  spec.width = width;
  if (height) spec.height = height;
  if (adjust) adjust(spec);
  container.replaceChildren();
  const view = new vega.View(vega.parse(spec, themeConfig()), {renderer: 'svg', container, logLevel: vega.Error});
  view.run();
  return view;
}
