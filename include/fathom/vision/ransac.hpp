#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/options.hpp"
#include "fathom/geometry/pose.hpp"
#include "fathom/vision/registration_tuning.hpp"

namespace fathom {

/// Which of two motions with enough inliers is kept.
enum class RansacScore {
  inliers,  ///< the one with more inliers; of equals, the one with the lower RMS
  paper  ///< the one with the lower sum of squared errors ε, as in the figure: favours small sets
};

struct RansacOptions {
  int iterations = 10000;
  double confidence = 0.999999;
  int sample_size = 2;
  double max_error_px = 7.5;                         ///< of the picture with the coarser pixels
  std::optional<double> max_error_m = std::nullopt;  ///< on the floor instead, at every altitude
  int min_inliers = 12;
  int min_places = 8;
  RansacScore score = RansacScore::inliers;

  void describe(OptionTable& table);

  /// The largest error of a match that agrees, for pictures whose coarser pixels are so wide on the
  /// floor. Throws InputError where that is no positive number of metres.
  double max_error_on_floor(double metres_per_pixel) const;
};

/// What RANSAC agrees on.
struct Consensus {
  std::optional<Pose> motion;  ///< of `to` in `from`; nothing: not found
  std::vector<int> inliers;    ///< rising indices of the pairs that agree; empty if not found
  double rms_m = 0.0;          ///< of the inliers' errors
  int most_inliers = 0;        ///< pairs that agreed with the best-supported trial, found or not
  int most_places = 0;  ///< most places of a trial with `min_inliers`, counted up to `min_places`
};

/// The paper's figure 2, on matched points p (seen in `from`) and q (seen in `to`), metres. Each of
/// the `iterations`:
/// 1. draws `sample_size` pairs at random and fits find_motion to them. A sample whose points lie
///    within `max_error_m` of their centre (root mean square) on either side, such as one match
///    drawn as two, fixes no heading and is drawn again, up to `redraws` times an iteration;
/// 2. tests every pair: it agrees where ‖p − z ⊕ q‖ ≤ `max_error_m`. The sample's own pairs are
/// held
///    to it as well: with least squares they need not meet it;
/// 3. lets the motion count only where at least `min_inliers` agree, in at least `min_places`;
/// 4. fits find_motion to all that agree;
/// 5. keeps the best fit by `score`.
///
/// Places are our addition to the figure. Matches nearer to each other than `max_error_m` are no
/// independent votes: a motion that brings one within the error brings its neighbours along. A
/// place is a match further than that from the other places, in both pictures. On real pictures
/// wrong motions gather a dozen matches on one object that looks like another, in few places; right
/// ones have theirs all over the overlap (tests/vision/real_pictures_test.cpp). 1 switches it off.
///
/// With score `inliers` the best is then settled: pairs are tested again with the fitted motion,
/// and it is fitted again, until they no longer change (`refit_rounds` at most; a round that loses
/// inliers or has too few places is not taken). With score `paper` the procedure ends as the figure
/// does.
///
/// It also ends before the last iteration, once a sample of nothing but inliers of the best motion
/// has been drawn with probability `confidence`: after log(1 − confidence) / log(1 − wᴺ), w the
/// share of inliers, N the size of a sample (Fischler and Bolles 1981). With score `paper` the
/// motion that wins need not be the one with most inliers, and all are made.
///
/// Points have no pixels, so `max_error_m` must be given. Same arguments, same answer. Throws
/// InputError where the two counts differ, or without `max_error_m`.
Consensus ransac(std::span<const Eigen::Vector2d> p, std::span<const Eigen::Vector2d> q,
                 const RansacOptions& options, std::uint64_t seed, const RansacTuning& tuning = {});

}  // namespace fathom
