#include "survey_coverage.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <system_error>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/image_folder.hpp"

namespace fathom {
namespace {

bool is_covered(const std::vector<std::int64_t>& times_ns, std::int64_t time_ns) {
  const auto after = std::ranges::lower_bound(times_ns, time_ns);
  if (after == times_ns.end()) return false;
  if (*after == time_ns) return true;
  return after != times_ns.begin() &&
         *after - *std::prev(after) <= ImageFolder::kMaxInterpolationGapNs;
}

std::string span_text(const std::string& topic, std::int64_t first_ns, std::int64_t last_ns) {
  return fmt::format("{} is from {} to {} s", topic, seconds_text(first_ns), seconds_text(last_ns));
}

}  // namespace

std::vector<NeededTimes> needed_times(const BagSurvey& survey, const TopicChoice& choice,
                                      const std::vector<BagTopic>& topics) {
  std::vector<NeededTimes> needed;
  if (choice.altitude) {
    needed.push_back({topics[*choice.altitude].name, {}});
    for (const auto& reading : survey.altitudes) needed.back().times_ns.push_back(reading.first);
  }
  if (choice.odometry) {
    needed.push_back({topics[*choice.odometry].name, {}});
    for (const auto& reading : survey.odometry) needed.back().times_ns.push_back(reading.time_ns);
  }
  if (choice.attitude && choice.is_attitude_needed) {
    needed.push_back({topics[*choice.attitude].name, attitude_times(survey)});
  }
  return needed;
}

std::vector<std::int64_t> attitude_times(const BagSurvey& survey) {
  std::vector<std::int64_t> times_ns;
  for (const AttitudeReading& reading : survey.attitudes) times_ns.push_back(reading.time_ns);
  return times_ns;
}

std::size_t uncovered(const std::vector<WrittenPicture>& pictures,
                      const std::vector<std::int64_t>& times_ns) {
  return static_cast<std::size_t>(std::ranges::count_if(
      pictures,
      [&](const WrittenPicture& picture) { return !is_covered(times_ns, picture.time_ns); }));
}

void check_spans(const std::vector<WrittenPicture>& pictures, const std::string& picture_topic,
                 const std::vector<NeededTimes>& needed) {
  constexpr double kNanosecond_s = 1e-9;
  if (pictures.empty()) throw InputError("topic " + picture_topic + " has no pictures");
  const std::int64_t first = pictures.front().time_ns;
  const std::int64_t last = pictures.back().time_ns;
  for (const NeededTimes& other : needed) {
    if (other.times_ns.empty()) {
      throw InputError("topic " + other.topic + " has no value that could be used");
    }
    const std::int64_t begin = other.times_ns.front();
    const std::int64_t end = other.times_ns.back();
    if (begin <= last && end >= first) continue;
    const double offset_s = static_cast<double>(begin - first) * kNanosecond_s;
    throw InputError(fmt::format(
        "two clocks disagree: {}, {}, {} s {}; --clock record takes the times of recording of both",
        span_text(picture_topic, first, last), span_text(other.topic, begin, end),
        short_number(std::abs(offset_s), 6), offset_s > 0.0 ? "later" : "earlier"));
  }
}

std::size_t leave_out_uncovered(std::vector<WrittenPicture>& pictures,
                                const std::filesystem::path& folder,
                                const std::vector<NeededTimes>& needed) {
  const std::size_t left_out = std::erase_if(pictures, [&](const WrittenPicture& picture) {
    const bool is_usable = std::ranges::all_of(needed, [&](const NeededTimes& other) {
      return is_covered(other.times_ns, picture.time_ns);
    });
    std::error_code error;
    if (!is_usable) std::filesystem::remove(folder / picture.file, error);
    return !is_usable;
  });
  if (!pictures.empty()) return left_out;
  std::vector<std::string> names;
  names.reserve(needed.size());
  for (const NeededTimes& other : needed) names.push_back(other.topic);
  throw InputError("no picture lies between two readings of " + joined(names, " and ") +
                   " at most 2 s apart");
}

}  // namespace fathom
