#pragma once

#include <string>
#include <vector>

#include "measure.hpp"

namespace fathom::benchmarks {

/// Costs of all estimators over one log, in either mode.
struct LogCosts {
  std::string name;
  std::size_t keyframes = 0;
  std::size_t loops = 0;
  std::vector<Cost> costs;
};

/// Two tables, batch and incremental, as Markdown. `/ Ceres` is the time in units of a batch solve
/// by ceres_pose_graph; the gap is that of F to the least F that any batch solve reached.
std::string markdown(const LogCosts& log);

/// Times of several logs, as Markdown and, incremental totals, as a chart.
struct Growth {
  std::vector<LogCosts> batch;  ///< by keyframes
  std::vector<LogCosts> by_keyframes;
  std::vector<LogCosts> by_loops;
};
std::string markdown(const Growth& growth);
/// An SVG file.
std::string chart(const Growth& growth);

}  // namespace fathom::benchmarks
