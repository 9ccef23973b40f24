#pragma once

#include <filesystem>
#include <vector>

#include "bag_survey.hpp"
#include "fathom/datasets/import.hpp"

namespace fathom {

/// Writes the sensors of a survey whose pictures are in `mav0`/cam0/data: cam0, altimeter0 and,
/// where it has them, odometry0, state_groundtruth_estimate0 and compass0. Throws InputError.
ImportReport write_survey(const BagSurvey& survey, const std::vector<BagTopic>& topics,
                          const TopicChoice& choice, const BagImportOptions& options,
                          const std::filesystem::path& mav0);

}  // namespace fathom
