// The results of a study, out of its folder.

#include <map>
#include <optional>
#include <pybind11/stl.h>
#include <string>
#include <vector>

#include "fathom/configuration/axis_words.hpp"
#include "fathom/report/study_report.hpp"
#include "fathom/report/study_statistics.hpp"
#include "fathom/results/result_store.hpp"
#include "fathom/results/run_index.hpp"
#include "python/src/arrays.hpp"
#include "python/src/bindings.hpp"
#include "python/src/statistics.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

py::dict row_of(const RunRecord& run, const StudyDescription& study) {
  py::dict row;
  row["cell"] = run.key.cell;
  const std::vector<std::size_t> places = study.places_of(run.key.cell);
  for (std::size_t i = 0; i < study.axes.size(); ++i) {
    row[study.axes[i].name.c_str()] = study.axes[i].labels[places[i]];
  }
  row["survey"] = run.key.survey;
  row["trial"] = run.key.trial;
  row["estimator"] = run.key.estimator;
  row["outcome"] = run.outcome;
  row["fault"] = run.fault;
  for (const auto& [name, value] : run.metrics) row[name.c_str()] = value;
  return row;
}

py::list all_rows(const ResultStore& store) {
  py::list rows;
  for (const RunRecord& run : store.runs()) rows.append(row_of(run, store.study()));
  return rows;
}

std::vector<std::string> estimator_names(const ResultStore& store) {
  std::vector<std::string> names;
  for (const StudyEstimator& one : store.study().estimators) names.push_back(one.name);
  return names;
}

py::dict axes_of(const ResultStore& store) {
  py::dict axes;
  for (const StudyAxis& axis : store.study().axes) axes[axis.name.c_str()] = axis.labels;
  return axes;
}

// As they stand at a drawn axis, with their unit.
py::dict axis_titles(const ResultStore& store) {
  py::dict titles;
  for (const StudyAxis& axis : store.study().axes) titles[axis.name.c_str()] = title_of(axis);
  return titles;
}

// Nothing where there is no such run.
std::optional<std::map<std::string, py::array_t<double>>> all_series_of(const ResultStore& store,
                                                                        const RunKey& key) {
  const std::optional<RunRecord> run = store.run(key);
  if (!run) return std::nullopt;
  std::map<std::string, py::array_t<double>> arrays;
  for (const auto& [name, values] : run->series) arrays.emplace(name, array_of(values));
  return arrays;
}

std::vector<bool> failed_runs(const ResultStore& store) {
  std::vector<bool> failed;
  for (const RunRecord& run : store.runs()) failed.push_back(is_failed(run));
  return failed;
}

py::list all_means(const ResultStore& store) {
  py::list list;
  if (store.runs().empty()) return list;
  for (const StudyMeans& one : study_means(store)) {
    list.append(py::make_tuple(one.estimator, one.cell, one.runs, one.done, one.means));
  }
  return list;
}

py::object difference_of_two(const ResultStore& store, const std::string& metric,
                             const std::string& one, const std::string& other, std::size_t cell) {
  const auto found = study_difference(store, metric, one, other, cell);
  py::object told = dict_of(found);
  if (found) {
    told["trials"] = found->trials;
    told["over"] = found->is_over_surveys ? "surveys" : "trials";
  }
  return told;
}

}  // namespace

void bind_store(py::module_& module) {
  py::class_<ResultStore>(module, "_Store")
      .def(py::init([](const std::string& path) { return ResultStore::open(path); }),
           py::call_guard<py::gil_scoped_release>())
      .def("rows", &all_rows)
      .def("estimators", &estimator_names)
      .def("title", [](const ResultStore& store) { return store.study().title; })
      .def("configuration", [](const ResultStore& store) { return store.study().configuration; })
      .def("table", [](const ResultStore& store) { return study_table(store); })
      .def("axes", &axes_of)
      .def("axis_titles", &axis_titles)
      .def("metrics", [](const ResultStore& store) { return store.study().metrics; })
      .def("failed", &failed_runs)
      .def("means", &all_means)
      .def("not_ranked", &not_ranked_text)
      .def("means_over_best", &means_over_best)
      .def("series",
           [](const ResultStore& store, const std::string& estimator, std::size_t cell,
              std::size_t survey, std::size_t trial) {
             return all_series_of(store, {cell, survey, trial, estimator});
           })
      .def("interval",
           [](const ResultStore& store, const std::string& metric, const std::string& estimator,
              std::size_t cell) { return pair_of(study_interval(store, metric, estimator, cell)); })
      .def("difference", &difference_of_two)
      .def("independent_draws",
           [](const ResultStore& store, std::size_t cell, std::size_t surveys, std::size_t trials) {
             return independent_draws(store.study().repetition_of(cell), surveys, trials);
           });
}

}  // namespace fathom
