#pragma once

#include <compare>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/options.hpp"
#include "fathom/front_end/joined_stretches.hpp"
#include "fathom/geometry/keyframe_grid.hpp"
#include "fathom/geometry/trajectory.hpp"
#include "fathom/measurements/relative_pose.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

enum class CandidateMethod {
  automatic,        ///< distance where a distance is given, else possible_overlap
  distance,         ///< as in the paper: near the newest, as estimated
  mahalanobis,      ///< that, and those whose confidence ellipse reaches so near
  overlap,          ///< pictures that overlap, as estimated
  possible_overlap  ///< that, and those that may, by the estimate's uncertainty; within a budget
};

struct CandidateOptions {
  CandidateMethod method = CandidateMethod::automatic;
  std::optional<double> max_distance_m;  ///< of distance and mahalanobis
  double probability = 0.99;             ///< of mahalanobis and possible_overlap
  double min_overlap = 0.1;              ///< of overlap and possible_overlap
  int budget = 12;                       ///< of possible_overlap
  std::optional<int> max_per_keyframe;   ///< of the others: the best so many; absent: all
  int hole_budget = 12;                  ///< of all, over holes that are open; 0: as without holes

  void describe(OptionTable& table);

  /// What `automatic` stands for here; else the method itself.
  CandidateMethod method_in_force() const;
  /// Whether the method asks the estimate for its covariances.
  bool asks_covariances() const;
  /// The key that decides which method is in force, and the keys that have no effect with it; as
  /// described.
  std::string chooser() const;
  std::vector<std::string> ignored_keys() const;
  /// Throws InputError where the method needs a distance and none is given.
  void check() const;
};

/// Which earlier keyframes the newest is registered with.
struct Candidates {
  std::vector<std::size_t> keyframes;  ///< rising
  std::size_t left_out = 0;            ///< candidates beyond max_per_keyframe or a budget
  bool asked_covariances = false;      ///< of the trajectory
};

/// Finds loop candidates in one trajectory that grows and moves. Keyframes that are out of reach
/// are not looked at (KeyframeGrid); what is found is what a test of each keyframe would find. With
/// `mahalanobis` and `possible_overlap` each is tested, as the covariances of all motions are asked
/// for in any case.
///
/// `possible_overlap` keeps `budget` candidates, the best of each pass over the place first: a pass
/// is a row of candidates that followed each other, and consecutive pictures of one pass say much
/// the same. Of a pass the one of most overlap comes first, then the one that most probably
/// overlaps.
///
/// Over a hole in dead reckoning the estimate is a guess. The hole is open until a registration
/// over it is met by the estimate to within reach, or some motion over it is known so well that its
/// confidence ellipse of `probability` is no longer than the reach. Over an open hole, whatever the
/// method, those are candidates that the guess has near, as pictures may go on where dead reckoning
/// stops. Where none of them closes the hole, all others are whose confidence ellipse reaches
/// there, which may be every earlier keyframe: of these `hole_budget`, evenly spread and of each
/// newest keyframe others (in_turn). Where the number of candidates is limited, half the places are
/// theirs, and those that others leave. Without covariances there is no open hole.
class CandidateSearch {
 public:
  /// Throws InputError as CandidateOptions::check.
  CandidateSearch(const Camera& camera, const CandidateOptions& options);

  /// Those among keyframes 0 … end − 1 for the newest, which is the last of `stances`, those of
  /// all keyframes as measured. The trajectory must hold them all. `holes`: the keyframes that a
  /// hole leads to, rising.
  Candidates find(const TrajectoryView& trajectory, std::span<const Stance> stances,
                  std::size_t end, std::span<const std::size_t> holes = {});

  /// Those that are left over holes that stay open with what was found of the candidates before.
  Candidates over_holes(std::span<const RelativePose> found) const;

  /// All that was found of the newest keyframe, before the next search.
  void note(std::span<const RelativePose> registrations);

  /// Whether a keyframe `step` away, with these stances, is a candidate for certain.
  bool accepts(const Pose& step, const Stance& from, const Stance& to) const;

  /// How far apart two keyframes may be to be candidates: the distance given, or that at which
  /// their pictures, level and turned alike, share min_overlap along the longer side, and as much
  /// more as their tilts move what they see.
  double reach_m(const Stance& from, const Stance& newest) const;

 private:
  /// A keyframe, and how far from overlap (or reach) it is: squared, in sigmas.
  struct Chance {
    std::size_t keyframe = 0;
    double squared_sigmas = 0.0;
  };
  /// The same to be compared: the best first.
  struct Rank {
    double lack_of_overlap = 0.0;
    double squared_sigmas = 0.0;
    double distance_m = 0.0;
    std::size_t keyframe = 0;
    // NOLINTNEXTLINE(modernize-use-nullptr): said of what the compiler writes for it
    auto operator<=>(const Rank&) const = default;
  };

  bool by_overlap() const;
  double level_altitude_m(const Stance& stance) const;
  double overlap(const Pose& motion, const Stance& from, const Stance& to) const;
  std::vector<std::size_t> within_reach(const TrajectoryView& trajectory,
                                        std::span<const Stance> stances);
  bool is_candidate(const Pose& from, const Pose& newest, const Stance& stance_from,
                    const Stance& stance_newest) const;
  std::vector<Chance> near_as_estimated(const TrajectoryView& trajectory,
                                        std::span<const Stance> stances, std::size_t end);
  std::vector<Chance> perhaps_near(const std::vector<UncertainPose>& motions,
                                   std::span<const Stance> stances, std::size_t end) const;
  static std::vector<Chance> united(const std::vector<Chance>& near,
                                    const std::vector<Chance>& perhaps);
  std::vector<std::size_t> best(const TrajectoryView& trajectory, std::span<const Stance> stances,
                                const std::vector<Chance>& candidates,
                                std::optional<std::size_t> most) const;
  std::optional<std::size_t> limit() const;
  bool has_open_holes() const { return options_.hole_budget > 0 && !stretches_.are_one(); }
  bool is_wide(const UncertainPose& motion, double reach_m) const;
  void close_holes(const TrajectoryView& trajectory, std::span<const Stance> stances);
  void close_holes(const std::vector<UncertainPose>& motions, std::span<const Stance> stances);
  void take_over_holes(std::vector<Chance>& perhaps, const std::vector<Chance>& near,
                       std::size_t newest);
  std::optional<std::size_t> places(std::size_t newest) const;
  std::vector<Rank> ranked(const TrajectoryView& trajectory, std::span<const Stance> stances,
                           const std::vector<Chance>& candidates) const;
  static std::vector<std::size_t> order_of(const std::vector<Rank>& ranks);
  static std::vector<std::size_t> order_by_passes(const std::vector<Rank>& ranks);

  Camera camera_;
  CandidateOptions options_;
  CandidateMethod method_;
  double reach_per_metre_ = 0.0;  ///< of a footprint, from below the camera
  double side_per_metre_ = 0.0;   ///< of a footprint, the longer one
  double mount_m_ = 0.0;          ///< from the body's origin to the camera
  double quantile_ = 0.0;         ///< of χ², 2 degrees of freedom
  double highest_m_ = 0.0;        ///< of the altitudes so far, see level_altitude_m
  std::size_t stances_ = 0;       ///< so many of them
  std::optional<KeyframeGrid> grid_;
  JoinedStretches stretches_;
  std::vector<std::size_t> over_holes_;  ///< candidates of the newest over open holes
  std::size_t places_over_holes_ = 0;    ///< so many of them at most
  std::vector<RelativePose> noted_;      ///< over open holes, until the next search
};

/// The least (d − p)ᵀ S⁻¹ (d − p) over the points p within `radius_m` ≥ 0 of the origin: the
/// squared Mahalanobis distance of a position d of covariance S to that disc. Zero within; infinity
/// where S, which may be singular, leaves no way.
double squared_distance_to_disc(const Eigen::Vector2d& d, const Eigen::Matrix2d& S,
                                double radius_m);

}  // namespace fathom
