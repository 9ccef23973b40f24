#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/options.hpp"
#include "fathom/front_end/keyframe_grid.hpp"
#include "fathom/geometry/trajectory.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

enum class CandidateMethod {
  distance,     ///< as in the paper: near the newest, as estimated
  mahalanobis,  ///< that, and those whose confidence ellipse reaches so near
  overlap       ///< pictures that overlap, as estimated
};

struct CandidateOptions {
  CandidateMethod method = CandidateMethod::distance;
  double max_distance_m = 3.0;          ///< of distance and mahalanobis
  double probability = 0.99;            ///< of mahalanobis
  double min_overlap = 0.1;             ///< of overlap
  std::optional<int> max_per_keyframe;  ///< the best so many; absent: all

  void describe(OptionTable& table);

  /// Keys, as described, that have no effect with this method.
  std::vector<std::string> ignored_keys() const;
};

/// Which earlier keyframes the newest is registered with.
struct Candidates {
  std::vector<std::size_t> keyframes;  ///< rising
  std::size_t left_out = 0;            ///< candidates beyond max_per_keyframe
};

/// Finds loop candidates in one trajectory that grows and moves. Keyframes that are out of reach
/// are not looked at (KeyframeGrid); what is found is what a test of each keyframe would find. With
/// `mahalanobis` each is tested, as the covariances of all motions are asked for in any case.
class CandidateSearch {
 public:
  CandidateSearch(const Camera& camera, const CandidateOptions& options);

  /// Those among keyframes 0 … end − 1 for the newest, which is the last of `altitudes_m`, the
  /// altitudes of all keyframes as measured. The trajectory must hold them all.
  Candidates find(const TrajectoryView& trajectory, std::span<const double> altitudes_m,
                  std::size_t end);

  /// Whether a keyframe `step` away, at these altitudes, is a candidate for certain.
  bool accepts(const Pose& step, double altitude_from_m, double altitude_to_m) const;

 private:
  double overlap(const Pose& motion, double altitude_from_m, double altitude_to_m) const;
  std::vector<std::size_t> within_reach(const TrajectoryView& trajectory,
                                        std::span<const double> altitudes_m);
  bool is_candidate(const Pose& from, const Pose& newest, double altitude_from_m,
                    double altitude_newest_m) const;
  std::vector<std::size_t> perhaps_near(const TrajectoryView& trajectory, std::size_t end) const;
  Candidates best(const TrajectoryView& trajectory, std::span<const double> altitudes_m,
                  std::vector<std::size_t> keyframes) const;

  Camera camera_;
  CandidateOptions options_;
  double reach_per_metre_ = 0.0;  ///< of a footprint, from below the camera
  double mount_m_ = 0.0;          ///< from the body's origin to the camera
  double quantile_ = 0.0;         ///< of χ², 2 degrees of freedom
  double highest_m_ = 0.0;        ///< of the altitudes so far
  std::size_t altitudes_ = 0;     ///< so many of them
  std::optional<KeyframeGrid> grid_;
};

/// The least (d − p)ᵀ S⁻¹ (d − p) over the points p within `radius_m` ≥ 0 of the origin: the
/// squared Mahalanobis distance of a position d of covariance S to that disc. Zero within; infinity
/// where S, which may be singular, leaves no way.
double squared_distance_to_disc(const Eigen::Vector2d& d, const Eigen::Matrix2d& S,
                                double radius_m);

}  // namespace fathom
