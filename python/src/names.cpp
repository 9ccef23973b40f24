// Names that a user may misspell, and what the product knows of them.

#include <optional>
#include <pybind11/stl.h>
#include <string>
#include <vector>

#include "fathom/core/options.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "python/src/bindings.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

std::vector<std::string> metric_names() {
  std::vector<std::string> names;
  for (const Metric& metric : metric_catalogue()) names.push_back(metric.name);
  return names;
}

std::optional<py::dict> metric_of(const std::string& name) {
  const std::optional<Metric> metric = find_metric(name);
  if (!metric) return std::nullopt;
  return py::dict(py::arg("label") = metric->label, py::arg("unit") = metric->unit,
                  py::arg("lower_is_better") = metric->better == Better::lower);
}

}  // namespace

void bind_names(py::module_& module) {
  module.def("_suggestion", &suggestion);
  module.def("_metric_names", &metric_names);
  module.def("_metric", &metric_of);
}

}  // namespace fathom
