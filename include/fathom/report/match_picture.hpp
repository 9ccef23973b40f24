#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "fathom/geometry/pose.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

/// The pixels (u right, v down) at which two pictures show the same feature.
struct PixelPair {
  Eigen::Vector2d a;
  Eigen::Vector2d b;
};

/// Two pictures and their matches: figure 1 of the paper has them all, figure 3 the accepted ones.
struct MatchPicture {
  cv::Mat a;  ///< 8-bit, one or three channels
  cv::Mat b;
  std::string name_a;
  std::string name_b;
  std::vector<PixelPair> matches;  ///< the distinct ones, before RANSAC
  /// Those that agree with the motion found; where none was found, with the best supported one, if
  /// that is known. There may be some that are not among `matches`.
  std::vector<PixelPair> inliers;
  std::string not_found;  ///< why no motion was found; empty: one was
};

/// The pictures side by side with every match: blue discs those that agree, orange rings those that
/// do not. All are marked at both ends, but of many only some are joined by lines, at most 90, from
/// all over the picture: more would hide it. 8-bit BGR, at most 1640 pixels wide. Dark pictures are
/// brightened, both alike. Throws InputError on an empty picture or another type.
cv::Mat render_raw_matches(const MatchPicture& picture);

/// The same with all inliers and nothing else.
cv::Mat render_accepted_matches(const MatchPicture& picture);

/// A picture of the floor with what is needed to lay it there.
struct FloorPicture {
  cv::Mat image;  ///< 8-bit, one or three channels, undistorted or not, of the camera's size
  Camera camera;
  double altitude_m = 0.0;
};

/// Both pictures on the floor at the motion found, in the body frame of A, x up and y to the left:
/// A in orange and B in blue, which add up to grey where they agree. 8-bit BGR, at most 1600 pixels
/// wide or high. `motion_a_b` is the pose of B's body in A's.
/// Throws InputError on pictures as above, of another size than their camera's, on an altitude that
/// is not positive, or a motion that is not finite or so far that the pictures would be specks.
cv::Mat render_overlay(const FloorPicture& a, const FloorPicture& b, const Pose& motion_a_b);

}  // namespace fathom
