#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bag_survey.hpp"

namespace fathom {

/// The times of readings that every picture needs, in order, and what they are called.
struct NeededTimes {
  std::string topic;
  std::vector<std::int64_t> times_ns;
};

/// Those of the altitudes, the odometry and an attitude that was asked for, where they are taken
/// from topics.
std::vector<NeededTimes> needed_times(const BagSurvey& survey, const TopicChoice& choice,
                                      const std::vector<BagTopic>& topics);

std::vector<std::int64_t> attitude_times(const BagSurvey& survey);

/// Pictures that no readings lie around.
std::size_t uncovered(const std::vector<WrittenPicture>& pictures,
                      const std::vector<std::int64_t>& times_ns);

/// Throws InputError with the offset where the pictures and what they need share no time.
void check_spans(const std::vector<WrittenPicture>& pictures, const std::string& picture_topic,
                 const std::vector<NeededTimes>& needed);

/// Removes the pictures that an image folder could not use, as it extrapolates nothing (a reading
/// at the time itself, or one on either side, at most 2 s apart), and their files. Returns how
/// many. Throws InputError where none is left.
std::size_t leave_out_uncovered(std::vector<WrittenPicture>& pictures,
                                const std::filesystem::path& folder,
                                const std::vector<NeededTimes>& needed);

}  // namespace fathom
