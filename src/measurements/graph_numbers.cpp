#include "fathom/measurements/graph_numbers.hpp"

#include <fmt/format.h>

#include "fathom/core/text.hpp"

namespace fathom {

bool has_large_ids(const MeasurementLog& log) {
  constexpr std::int64_t kLastStamp = 9'000'000'000;
  return !log.ids.empty() && log.ids.back() > kLastStamp;
}

std::vector<std::int64_t> stamps_of(const MeasurementLog& log) {
  if (!has_large_ids(log)) return log.ids;
  std::vector<std::int64_t> stamps;
  for (std::size_t k = 0; k < log.ids.size(); ++k) stamps.push_back(static_cast<std::int64_t>(k));
  return stamps;
}

std::string ids_csv(const MeasurementLog& log) {
  std::string text = "stamp,id\n";
  const std::vector<std::int64_t> stamps = stamps_of(log);
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    text += std::to_string(stamps[k]) + ',' + std::to_string(log.ids[k]) + '\n';
  }
  return text;
}

std::vector<std::string> graph_remarks(const MeasurementLog& log) {
  std::vector<std::string> remarks;
  if (log.self_edges > 0) {
    remarks.push_back(counted(log.self_edges, "edge") + " from a pose to itself left out");
  }
  if (has_large_ids(log)) {
    remarks.push_back(
        fmt::format("ids up to {} are too large for time stamps: trajectories have 0 to {} in "
                    "their place, in the order of the ids; ids.csv has both",
                    log.ids.back(), log.ids.size() - 1));
  }
  return remarks;
}

}  // namespace fathom
