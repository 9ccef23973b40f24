#include "python/src/python_report.hpp"

#include <fmt/format.h>
#include <optional>
#include <string>
#include <vector>

#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

template <class Name>
Name named(const py::handle& word, const std::vector<Name>& all, const std::string& what) {
  const std::string text = py::str(word).cast<std::string>();
  std::string known;
  for (const Name name : all) {
    if (name_of(name) == text) return name;
    known += (known.empty() ? "" : ", ") + name_of(name);
  }
  throw InputError(fmt::format("{}: got '{}', expected {}", what, text, known));
}

Outcome outcome_of(const py::handle& word) {
  using enum Outcome;
  return named<Outcome>(word, {converged, iteration_limit, diverged, numerical_failure}, "outcome");
}

LoopFate fate_of(const py::handle& word) {
  using enum LoopFate;
  return named<LoopFate>(word, {used, rejected, lost}, "fate");
}

// A fate alone, or with the normalised innovation squared: "used", ("rejected", 31.2).
template <class Decision>
void decide(const py::handle& given, Decision& decision) {
  if (!py::isinstance<py::tuple>(given)) {
    decision.fate = fate_of(given);
    return;
  }
  const auto both = py::reinterpret_borrow<py::tuple>(given);
  if (both.size() != 2) throw InputError("a decision: expected a fate, or (fate, nis)");
  decision.fate = fate_of(both[0]);
  if (!both[1].is_none()) decision.nis = both[1].cast<double>();
}

// `decisions`: None, all as the outcome says, or a list in the order given.
template <class Decision>
void decide_all(const py::object& given, Outcome outcome, std::vector<Decision>& decisions) {
  if (given.is_none()) return;
  const auto list = py::list(given);
  if (list.size() != decisions.size()) {
    throw InputError(
        fmt::format("a report has {} decisions, expected {}", list.size(), decisions.size()));
  }
  const LoopFate impossible = is_done(outcome) ? LoopFate::lost : LoopFate::used;
  for (std::size_t i = 0; i < decisions.size(); ++i) {
    decide(list[i], decisions[i]);
    if (decisions[i].fate != impossible) continue;
    throw InputError(fmt::format("a report of {} has a decision '{}', expected {}",
                                 name_of(outcome), name_of(impossible),
                                 is_done(outcome) ? "used or rejected" : "lost or rejected"));
  }
}

UpdateReport report_without_decisions(const py::object& given) {
  if (!py::hasattr(given, "outcome")) {
    throw InputError("returned an object of " +
                     py::type::of(given).attr("__qualname__").cast<std::string>() +
                     ", expected an UpdateReport or None");
  }
  UpdateReport report;
  report.outcome = outcome_of(given.attr("outcome"));
  report.iterations = given.attr("iterations").cast<int>();
  if (report.iterations < 0) {
    throw InputError(
        fmt::format("a report has {} iterations, expected 0 or more", report.iterations));
  }
  return report;
}

}  // namespace

UpdateReport report_of(const py::object& given, const Measurements& measurements) {
  UpdateReport report;
  if (!given.is_none()) report = report_without_decisions(given);
  const LoopFate fate = is_done(report.outcome) ? LoopFate::used : LoopFate::lost;
  for (const RelativePose& z : measurements.registrations) {
    report.loops.push_back({z.from, z.to, fate, std::nullopt});
  }
  for (const AbsolutePose& z : measurements.absolute) {
    report.absolute.push_back({z.keyframe, fate, std::nullopt});
  }
  if (given.is_none()) return report;
  decide_all(given.attr("loops"), report.outcome, report.loops);
  decide_all(given.attr("absolute"), report.outcome, report.absolute);
  return report;
}

UpdateReport report_of_solve(const py::object& given) {
  if (given.is_none()) return {};
  const UpdateReport report = report_without_decisions(given);
  if (!given.attr("loops").is_none() || !given.attr("absolute").is_none()) {
    throw InputError("the report of a solve has decisions, which are those of the updates");
  }
  return report;
}

}  // namespace fathom
