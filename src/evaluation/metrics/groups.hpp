#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fathom/evaluation/metrics.hpp"

namespace fathom {

inline void append(std::vector<Metric>& all, const std::vector<Metric>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

// A metric is an entry of one of these lists, each in the file of its name.
std::vector<Metric> accuracy_metrics();
std::vector<Metric> consistency_metrics();
std::vector<Metric> honesty_metrics();
std::vector<Metric> held_out_metrics();
std::vector<Metric> loop_metrics();
std::vector<Metric> absolute_metrics();
std::vector<Metric> optimum_metrics();
std::vector<Metric> cost_metrics();

/// Relative errors over separations in keyframes and distances in metres, as words: those that are
/// no numbers name the whole family and are never known.
std::vector<Metric> relative_error_metrics(const std::vector<std::string>& keyframes,
                                           const std::vector<std::string>& distances_m);

/// The relative error of that name.
std::optional<Metric> relative_error_metric(const std::string& name);

/// ANEES of motions over separations in keyframes and distances in metres, as words likewise.
std::vector<Metric> relative_consistency_metrics(const std::vector<std::string>& keyframes,
                                                 const std::vector<std::string>& distances_m);

/// The ANEES of motions of that name.
std::optional<Metric> relative_consistency_metric(const std::string& name);

Metric anchored_anees_metric();

/// F of the whole log at the estimate, as its estimator has it.
double cost_of(const RunFacts& facts);

/// The value of a metric that is a member of the run, a number or an optional one.
template <class Field>
auto run_field(Field Run::*field) {
  return [field](const JudgedRun& run) -> std::optional<double> {
    if (run.facts.run == nullptr) return std::nullopt;
    const std::optional value = (*run.facts.run).*field;
    return value ? std::optional(static_cast<double>(*value)) : std::nullopt;
  };
}

}  // namespace fathom
