#include "fathom/harness/false_loops.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "fathom/core/files.hpp"
#include "fathom/core/text.hpp"
#include "fathom/harness/recording_facts.hpp"

namespace fathom {
namespace {

constexpr const char* kHeader = "registration,from,to";

std::vector<RelativePose> registrations_of(const MeasurementLog& log) {
  std::vector<RelativePose> all;
  for (std::size_t k = 1; k < log.size(); ++k) {
    const auto& own = log.arrival(k).registrations;
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

std::string row_of(std::size_t place, const RelativePose& z, const MeasurementLog& log) {
  const auto id = [&log](std::size_t k) {
    return std::to_string(log.ids.empty() ? static_cast<std::int64_t>(k) : log.ids[k]);
  };
  return std::to_string(place) + ',' + id(z.from) + ',' + id(z.to);
}

}  // namespace

std::vector<Pose> reference_poses(const Recording& recording, const EstimatorRegistry& registry) {
  if (recording.ground_truth) return *recording.ground_truth;
  std::vector<Pose> odometry = recording.log.odometry();
  auto optimum = batch_optimum(recording.log, registry);
  const bool is_better = optimum && optimum->chi2 < chi2(recording.log, odometry);
  return is_better ? std::move(optimum->poses) : odometry;
}

void spoil_recording(Recording& recording, const SpoilOptions& options,
                     const EstimatorRegistry& registry, std::uint64_t seed, std::uint64_t trial) {
  if (recording.log.registration_count() == 0) return;
  const std::vector<Pose> reference = reference_poses(recording, registry);
  Spoiled spoiled = spoil(recording.log, reference, options, seed, trial);
  recording.log = std::move(spoiled.log);
  recording.is_false_loop = std::move(spoiled.is_false);
}

std::string false_loops_csv(const Spoiled& spoiled) {
  std::string text = std::string(kHeader) + '\n';
  const std::vector<RelativePose> all = registrations_of(spoiled.log);
  for (std::size_t place = 0; place < all.size(); ++place) {
    if (spoiled.is_false[place]) text += row_of(place, all[place], spoiled.log) + '\n';
  }
  return text;
}

std::vector<bool> read_false_loops(const std::filesystem::path& path, const MeasurementLog& log) {
  const std::vector<RelativePose> all = registrations_of(log);
  std::vector<bool> is_false(all.size(), false);
  const std::string content = read_text(path);
  bool has_header = false;
  for (const auto& [line, row] : lines_of(content)) {
    if (!std::exchange(has_header, true)) {
      if (row != kHeader) {
        throw InputError(path.string(), line, std::string("expected the header ") + kHeader);
      }
      continue;
    }
    const auto place = parse_integer(row.substr(0, row.find(',')));
    const bool is_there = place && *place >= 0 && static_cast<std::size_t>(*place) < all.size();
    if (!is_there || row_of(static_cast<std::size_t>(*place), all[static_cast<std::size_t>(*place)],
                            log) != row) {
      throw InputError(path.string(), line, in_quotes(row) + " is no registration of this graph");
    }
    is_false[static_cast<std::size_t>(*place)] = true;
  }
  return is_false;
}

}  // namespace fathom
