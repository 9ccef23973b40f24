#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fathom/core/options.hpp"
#include "fathom/front_end/front_end.hpp"
#include "fathom/front_end/registration_plan.hpp"

namespace fathom {

/// What the front end will make of a survey, as far as dead reckoning tells before any picture is
/// registered.
struct Outlook {
  /// Of the picture from the median altitude: abeam and ahead.
  double footprint_width_m = 0.0;
  double footprint_height_m = 0.0;
  /// The rest needs dead reckoning, and two keyframes.
  std::size_t keyframes = 0;
  std::optional<FrontEndInMetres> in_metres;
  /// Pairs of keyframes that will be tried, by dead reckoning's poses: consecutive ones, and
  /// others.
  std::size_t consecutive_candidates = 0;
  std::size_t other_candidates = 0;
  std::optional<ReckonedLoop> widest;  ///< of the others, as RegistrationPlan::widest
  /// Features found in some pictures, by frame: few say that there is little to register.
  std::vector<std::pair<std::size_t, std::size_t>> features;
  std::vector<std::string> remarks;  ///< on what of the pictures is masked, and which repeat
};

/// Looks at the positions of all frames and at some pictures. Throws InputError where a picture
/// cannot be read.
Outlook outlook(const FrameSource& frames, const FrontEndOptions& options);

/// The same in words: facts, and what looks wrong.
std::vector<std::string> facts_of(const Outlook& outlook);
std::vector<std::string> warnings_of(const Outlook& outlook, const FrontEndOptions& options);

}  // namespace fathom
