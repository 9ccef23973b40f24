#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fathom/evaluation/judged_run.hpp"

namespace fathom {

/// Which of two values of a metric is the better one.
enum class Better {
  lower,
  higher,
  neither,  ///< a mere count, or a value that is best in between
};

/// A measure of a run's accuracy, consistency or cost. Its name is the same in metrics.json, in the
/// store, in tables and on the command line, and ends with the unit where there is one.
struct Metric {
  std::string name;
  std::string label;  ///< for tables and charts: "mean position error"
  std::string unit;   ///< "m", "rad", "ms" or "bytes"; empty of counts and ratios
  Better better = Better::neither;
  std::string description;
  /// Nothing where it is not known. A value that is not finite counts as not known.
  std::function<std::optional<double>(const JudgedRun&)> value;
  bool is_cost = false;     ///< depends on the machine, so that it differs from run to run
  bool is_aligned = false;  ///< an error after the alignment that it was judged with

  /// "mean position error (m)"
  std::string label_with_unit() const { return unit.empty() ? label : label + " (" + unit + ")"; }
};

/// Every metric there is. Relative errors stand for all of theirs: N of `rpe_N_keyframes_m` is a
/// separation and D of `rpe_D_m_m` a distance.
const std::vector<Metric>& metric_catalogue();

/// The metric of that name, a relative error over any separation or distance included.
std::optional<Metric> find_metric(const std::string& name);

/// Whether a metric depends on the machine (times and memory); false of a name that is no metric.
bool is_cost_metric(const std::string& name);

/// All metrics of a run that are known and finite, by name, the relative errors those of its
/// options.
std::map<std::string, double> metric_values(const JudgedRun& run);

}  // namespace fathom
