#pragma once

#include <optional>
#include <string>

#include "fathom/harness/outlook.hpp"
#include "fathom/measurements/loop_terms.hpp"

namespace fathom {

/// A loop that misses by more before its update may lead steps into a wrong minimum. Without its
/// search for a lower one `incremental_smoother` ended there on drawn logs, at 0.41 rad and more
/// alone; `sparse_gauss_newton` never did (docs/which_back_end.md).
inline constexpr double kMisfitOfWrongMinima_rad = 0.3;

/// LoopTerms::curvature below which `trajectory_iekf` ends where the graphs end: a loop is left
/// within its own σ by one linearisation. Drawn likewise.
inline constexpr double kCurvatureOfFilters = 1.0;

/// Fewer loops a keyframe than this, and `trajectory_iekf` costs less than a graph while nobody
/// asks for covariances: its own has its form for few loops.
inline constexpr double kFewLoopsPerKeyframe = 0.02;

/// Which back end suits a log or a survey, and why.
struct Advice {
  std::string estimator;  ///< its type
  std::string since;      ///< the terms with their numbers, a sentence without its end
};

/// The rule of docs/which_back_end.md. Its only place.
Advice advise(const LoopTerms& terms);

/// The same before a picture is registered: a misfit of two σ of dead reckoning's heading is
/// expected. Nothing is known where the survey has no dead reckoning of its own.
std::optional<Advice> advise(const Outlook& outlook);

/// "for this log: ESTIMATOR, since …".
std::string text_of(const Advice& advice, const std::string& what = "log");

}  // namespace fathom
