#pragma once

#include <string>
#include <vector>

#include "fathom/vision/features.hpp"
#include "fathom/vision/matching.hpp"

namespace fathom {

/// Two pictures in which the same pixels agree are of a vehicle at rest, or of something in view
/// that moves with the camera: its frame, burnt-in text. At rest most of the picture agrees. So
/// where all matches stay within a pixel, at least half of the cells of a grid over the picture in
/// which `from` has features must have some of the matches. The reason if they have not; empty:
/// the matches move, or the vehicle is at rest.
std::string reason_of_what_stays(const Features& from, const Features& to,
                                 const std::vector<Match>& matches);

}  // namespace fathom
