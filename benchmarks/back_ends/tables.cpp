#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "output.hpp"

namespace fathom::benchmarks {
namespace {

constexpr const char* kNothing = "–";

std::string number(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, value < 1e4 ? "%.3g" : "%.0f", value);
  return buffer;
}

std::string number(const std::optional<double>& value) {
  return value ? number(*value) : kNothing;
}

double least_chi2(const LogCosts& log) {
  double least = std::numeric_limits<double>::infinity();
  for (const Cost& cost : log.costs) {
    if (cost.gave_up || !is_done(cost.outcome)) continue;
    if (cost.mode == SolveMode::batch) least = std::min(least, cost.chi2);
  }
  return least;
}

std::optional<double> ceres_ms(const LogCosts& log) {
  for (const Cost& cost : log.costs) {
    if (cost.mode == SolveMode::batch && cost.estimator == "ceres_pose_graph") return cost.total_ms;
  }
  return std::nullopt;
}

std::string chi2_cells(const Cost& cost, double optimum) {
  if (cost.gave_up) return " | – | –";
  char buffer[64];
  const double gap = std::isnan(cost.chi2) ? cost.chi2 : std::max(0.0, cost.chi2 - optimum);
  std::snprintf(buffer, sizeof buffer, " | %.8g | %s", cost.chi2,
                gap < 1e-6 * optimum || gap < 1e-9 ? "0" : number(gap).c_str());
  return buffer;
}

std::string row(const Cost& cost, const LogCosts& log) {
  const std::optional<double> ceres = ceres_ms(log);
  std::string text = "| `" + cost.estimator + "` | " +
                     (cost.gave_up ? "gave up" : name_of(cost.outcome)) + " | " +
                     std::to_string(cost.linearisations) + " | " + (cost.gave_up ? "> " : "") +
                     number(cost.total_ms) + " | " + (ceres && cost.gave_up ? "> " : "") +
                     (ceres ? number(cost.total_ms / *ceres) : kNothing);
  if (cost.update_ms) {
    text += " | " + number(cost.update_ms->median) + " | " + number(cost.update_ms->p95) + " | " +
            number(cost.update_ms->max);
  } else if (cost.mode == SolveMode::incremental) {
    text += " | – | – | –";
  }
  return text + chi2_cells(cost, least_chi2(log)) + " | " + number(cost.covariance_ms) + " | " +
         number(cost.memory_mib) + " |\n";
}

std::string rows(const LogCosts& log, SolveMode mode) {
  std::string text;
  for (const Cost& cost : log.costs) {
    if (cost.mode == mode) text += row(cost, log);
  }
  return text;
}

std::string growth_table(const std::string& what, const std::vector<LogCosts>& logs,
                         std::size_t LogCosts::*count) {
  if (logs.empty()) return {};
  std::string text = "\n| " + what;
  std::string rule = "\n|---";
  for (const LogCosts& log : logs) {
    text += " | " + std::to_string(log.*count);
    rule += "|---";
  }
  text += " |" + rule + "|\n";
  for (std::size_t i = 0; i < logs.front().costs.size(); ++i) {
    text += "| `" + logs.front().costs[i].estimator + "`";
    for (const LogCosts& log : logs) {
      const Cost& cost = log.costs[i];
      text += " | " + (cost.gave_up ? kNothing : number(cost.total_ms));
    }
    text += " |\n";
  }
  return text;
}

}  // namespace

std::string markdown(const LogCosts& log) {
  return "\n## " + log.name + ": " + std::to_string(log.keyframes) + " keyframes, " +
         std::to_string(log.loops) +
         " loops\n\n"
         "| batch | outcome | linearisations | ms | / Ceres | chi2 | gap | covariances, ms | MiB "
         "|\n"
         "|---|---|---|---|---|---|---|---|---|\n" +
         rows(log, SolveMode::batch) +
         "\n| incremental | outcome | linearisations | total, ms | / Ceres | median | 95 % | "
         "longest "
         "| chi2 | gap | covariances, ms | MiB |\n"
         "|---|---|---|---|---|---|---|---|---|---|---|---|\n" +
         rows(log, SolveMode::incremental);
}

std::string markdown(const Growth& growth) {
  return "\n## Growth, ms\n" +
         growth_table("batch: keyframes, a loop for every third", growth.batch,
                      &LogCosts::keyframes) +
         growth_table("incremental: keyframes, a loop for every third", growth.by_keyframes,
                      &LogCosts::keyframes) +
         growth_table("incremental: loops, 2000 keyframes", growth.by_loops, &LogCosts::loops);
}

}  // namespace fathom::benchmarks
