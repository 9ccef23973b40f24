#include "fathom/measurements/graph_numbers.hpp"

#include <fmt/format.h>
#include <limits>

#include "fathom/core/text.hpp"

namespace fathom {
namespace {

// What doubles carry of a sum.
constexpr double kDigits = 1e16;

/// The strongest and the weakest information of a kind, and whose it is.
struct InformationRange {
  std::string kind;
  double most = 0.0;
  double least = std::numeric_limits<double>::infinity();
  const RelativePose* strongest = nullptr;
  const RelativePose* weakest = nullptr;

  // What is not measured is not weak.
  void add(double value, const RelativePose& z) {
    if (value > most) {
      most = value;
      strongest = &z;
    }
    if (value > 0.0 && value < least) {
      least = value;
      weakest = &z;
    }
  }
};

std::string ends_of(const MeasurementLog& log, const RelativePose& z) {
  const auto id_of = [&](std::size_t k) {
    return log.ids.empty() ? std::to_string(k) : std::to_string(log.ids[k]);
  };
  return id_of(z.from) + " and " + id_of(z.to);
}

void remark_on(const InformationRange& range, const MeasurementLog& log,
               std::vector<std::string>& remarks) {
  if (!(range.most > kDigits * range.least)) return;
  remarks.push_back(fmt::format(
      "the measurement of poses {} has {} information of {:.3g}, {:.0e} times the {:.3g} of poses "
      "{}: filters, whose sums carry 16 digits, lose the weaker; if a unit or a power of ten is "
      "wrong, mend it, else compare graph back ends alone",
      ends_of(log, *range.strongest), range.kind, range.most, range.most / range.least, range.least,
      ends_of(log, *range.weakest)));
}

void remark_on_information(const MeasurementLog& log, std::vector<std::string>& remarks) {
  InformationRange position{.kind = "position"};
  InformationRange heading{.kind = "heading"};
  const auto add = [&](const RelativePose& z) {
    for (int axis = 0; axis < 2; ++axis) position.add(z.information(axis, axis), z);
    heading.add(z.information(2, 2), z);
  };
  for (std::size_t k = 1; k < log.size(); ++k) {
    if (!log.arrival(k).step.is_hole) add(log.arrival(k).step);
    for (const RelativePose& z : log.arrival(k).registrations) add(z);
  }
  remark_on(position, log, remarks);
  remark_on(heading, log, remarks);
}

}  // namespace

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
  remark_on_information(log, remarks);
  return remarks;
}

}  // namespace fathom
