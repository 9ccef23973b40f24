#pragma once

#include <string>

namespace fathom {

/// How a metric is called in tables and charts, and in what unit it is; an empty one for counts and
/// ratios.
struct MetricLabel {
  std::string text;  ///< "mean position error"
  std::string unit;  ///< "m"

  /// "mean position error (m)"
  std::string with_unit() const { return unit.empty() ? text : text + " (" + unit + ")"; }
};

/// For a metric of docs/formats.md, rpe_10_keyframes_m and update_ms.p95 among them; any other name
/// is read by its ending, `_m`, `_rad`, `_ms`, `_s` or `_bytes`.
MetricLabel metric_label(const std::string& metric);

}  // namespace fathom
