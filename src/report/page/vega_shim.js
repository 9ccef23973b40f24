// Vega comes as modules for a loader of AMD kind. This is as much of one as they need: each file is
// preceded by a line that sets `vegaModule`, and its dependencies have all been loaded before.
var vegaModules = {};
var vegaModule = '';
function define(needs, factory) {
  const exported = (vegaModules[vegaModule] = {});
  factory(...needs.map((name) => {
    if (name === 'exports') return exported;
    // The package's vega-functions asks for vega-selection by another name.
    const found = vegaModules[name === 'vega-selections' ? 'vega-selection' : name];
    if (!found) throw new Error(vegaModule + ' needs ' + name);
    return found;
  }));
}
define.amd = {};
