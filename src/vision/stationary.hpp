#pragma once

#include <string>
#include <vector>

#include "fathom/vision/features.hpp"
#include "fathom/vision/matching.hpp"

namespace fathom {

/// Not calibrated: any values near these tell a vehicle at rest (all cells agree, also with a
/// sensor's noise of 10 grey levels) from a bar over a fifth of the picture (a quarter of them do);
/// tests/vision/stationary_test.cpp. A change raises kRegistrationVersion.
struct StationaryRule {
  double most_motion_px = 1.0;
  double share_of_matches = 0.95;  ///< that stay: the fit leaves out few that agree by chance
  int cells = 8;                   ///< along each side of the picture
  int least_features = 3;          ///< of a cell that is to have a match
  double least_cells = 0.5;        ///< of these, that have one
};

/// Which of the matches stay within `most_motion_px` in the picture. They say nothing of the floor
/// where it moves. None of points that come without pixels.
std::vector<int> staying(const Features& from, const Features& to,
                         const std::vector<Match>& matches, const StationaryRule& rule = {});

/// Two pictures in which the same pixels agree are of a vehicle at rest, or of something in view
/// that moves with the camera: its frame, burnt-in text. At rest most of the picture agrees. So
/// where all inliers stay within a pixel, at least half of the cells of a grid over the picture in
/// which `from` has features must have some of them, or of the other matches that stay: where an
/// altitude is wrong, the inliers of a vehicle at rest are those about the middle of the picture.
/// The reason if they have not; empty: the inliers move, or the vehicle is at rest.
std::string reason_of_what_stays(const Features& from, const Features& to,
                                 const std::vector<Match>& inliers,
                                 const std::vector<Match>& matches,
                                 const StationaryRule& rule = {});

}  // namespace fathom
