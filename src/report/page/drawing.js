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

// Lines that lie on one another stay visible: the first estimator's is the broadest and the lowest.
// Where none do, the step is small.
const kBroadest = 7.4;
const kThinnest = 1.8;
function thicknessOf(name, lieOnOneAnother) {
  const compared = study.estimators.filter((one) => one.name !== kBaseline).map((one) => one.name);
  const place = compared.indexOf(name);
  if (place < 0) return kThinnest;
  const step = Math.min(lieOnOneAnother ? 2.8 : 0.5, (kBroadest - kThinnest) / Math.max(1, compared.length - 1));
  return kThinnest + step * (compared.length - 1 - place);
}

// The scales by which all charts colour and dash, whatever is shown.
function sharedScales(lieOnOneAnother) {
  const names = [kTruth, ...study.estimators.map((one) => one.name)];
  return [
    {name: 'colour', type: 'ordinal', domain: names, range: [css('--ink'), ...study.estimators.map((one) => one.colour)]},
    {name: 'thickness', type: 'ordinal', domain: names, range: [kBroadest + 1.8, ...study.estimators.map((one) => thicknessOf(one.name, lieOnOneAnother))]},
    {name: 'dash', type: 'ordinal', domain: names, range: [[], ...study.estimators.map((one) => dashesOf(one))]},
  ];
}

function drawPlot(container, specName, {data, width, height, signals = {}, adjust, same}) {
  const spec = structuredClone(specs[specName]);
  spec.scales.push(...sharedScales(Boolean(same)));
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
