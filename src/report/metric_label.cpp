#include "metric_label.hpp"

#include <array>
#include <regex>
#include <string_view>
#include <utility>

namespace fathom {
namespace {

using Known = std::pair<std::string_view, std::string_view>;

// What the name alone does not say well.
constexpr std::array<Known, 13> kKnown{{{"ate_rmse_m", "ATE RMSE"},
                                        {"anees", "ANEES"},
                                        {"position_anees", "position ANEES"},
                                        {"heading_rmse_rad", "heading RMSE"},
                                        {"share_inside_2_sigma", "share inside 2σ"},
                                        {"mean_nis_accepted", "mean NIS accepted"},
                                        {"chi2", "F"},
                                        {"chi2_used", "F of what was used"},
                                        {"chi2_optimum", "F at the optimum"},
                                        {"chi2_gap", "F above the optimum"},
                                        {"cpu_ms", "CPU time"},
                                        {"total_ms", "total time"},
                                        {"covariance_ms", "covariance time"}}};
constexpr std::array<Known, 5> kUnits{
    {{"_m", "m"}, {"_rad", "rad"}, {"_ms", "ms"}, {"_s", "s"}, {"_bytes", "bytes"}}};

std::string worded(std::string name) {
  for (char& letter : name) letter = letter == '_' ? ' ' : letter;
  return name;
}

}  // namespace

MetricLabel metric_label(const std::string& metric) {
  static const std::regex kRelative(R"(rpe_(.+)_(keyframes|m)_(m|rad))");
  static const std::regex kTimes(R"((.+)_ms\.(\w+))");
  std::smatch found;
  if (std::regex_match(metric, found, kRelative)) {
    const std::string over = found[2] == "m" ? "m" : found[1] == "1" ? "keyframe" : "keyframes";
    return {"RPE over " + found[1].str() + " " + over, found[3]};
  }
  if (std::regex_match(metric, found, kTimes)) {
    return {worded(found[1]) + " time, " + found[2].str(), "ms"};
  }
  MetricLabel label{worded(metric), ""};
  for (const auto& [ending, unit] : kUnits) {
    if (!metric.ends_with(ending) || metric.size() == ending.size()) continue;
    label = {worded(metric.substr(0, metric.size() - ending.size())), std::string(unit)};
  }
  for (const auto& [name, text] : kKnown) {
    if (name == metric) label.text = text;
  }
  return label;
}

}  // namespace fathom
