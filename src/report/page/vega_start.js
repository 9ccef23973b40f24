// What Vega's own bundle would do: make its transforms known, and gather what the page uses.
for (const name of ['vega-transforms', 'vega-view-transforms', 'vega-encode']) {
  Object.assign(vegaModules['vega-dataflow'].transforms, vegaModules[name]);
}
const vega = {
  parse: vegaModules['vega-parser'].parse,
  View: vegaModules['vega-view'].View,
  Error: vegaModules['vega-util'].Error,
};
delete window.define;
