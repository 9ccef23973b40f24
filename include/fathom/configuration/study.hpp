#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fathom/configuration/configuration.hpp"
#include "fathom/configuration/study_description.hpp"

namespace fathom {

/// A comparative study, checked: every cell of its sweep has a valid configuration.
struct Study {
  StudyDescription description;
  std::vector<Configuration> cells;  ///< in the order of the description
  /// What the noise streams of a cell's trials are seeded from, by `survey_seed`: the base seed and
  /// the cell's values, so that no draw depends on which other cells there are. Without a sweep:
  /// the base seed. What a survey has once depends on no cell, but on `survey_seed` of the base
  /// seed.
  std::vector<std::uint64_t> noise_seeds;
};

/// Checks a study: a comparison (`configure`) with a sweep
///
///     sweep:
///       - {key: front_end.keyframes.separation_frames, name: separation, values: [5, 10]}
///
/// over any key but those of the study itself; the cells are the product of the axes. Throws
/// InputError with the origin of the setting that is wrong.
Study configure_study(const Settings& settings, const EstimatorRegistry& registry);

/// Keys of a configuration with their values.
using KeyValues = std::vector<std::pair<std::string, std::string>>;

/// Whether a reference selects the loop candidates of a cell: association is shared, and there are
/// pictures to be registered.
bool selects_by_reference(const Configuration& cell);

/// What a study stores of its reference: `association.reference`, or the type and every option of
/// one that is no contender.
KeyValues reference_values(const CandidateReference& reference, const EstimatorRegistry& registry);

/// Puts this in the place of every reference that is `automatic`, in the cells and in what the
/// study is.
void settle_references(Study& study, CandidateReference::Kind kind,
                       const EstimatorRegistry& registry);

/// The settings without those of a sweep: what a study is in one cell, its base.
Settings without_sweep(const Settings& settings);

}  // namespace fathom
