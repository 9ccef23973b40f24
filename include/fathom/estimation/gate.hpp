#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/options.hpp"
#include "fathom/estimation/estimator.hpp"

namespace fathom {

/// The χ² gate of a measurement on its normalised innovation: 3 degrees of freedom of a
/// registration, of an absolute measurement as many as its information has rank.
struct GateOptions {
  /// Share of right registrations that passes, or off.
  std::optional<double> probability;
  /// Share of right sets of registrations of one keyframe that pass together, or off.
  std::optional<double> joint_probability;

  void describe(OptionTable& table);
  /// Of a filter, which has the joint covariance of its innovations at hand.
  void describe_joint(OptionTable& table);
};

class Gate {
 public:
  explicit Gate(const GateOptions& options);

  bool is_on() const { return thresholds_.has_value(); }
  /// NaN never passes.
  bool passes(double nis, int rank = 3) const;

  bool is_joint_on() const { return joint_probability_.has_value(); }
  /// The joint test of those that passed alone: see jointly_compatible. Those are returned where it
  /// is off.
  std::vector<bool> pass_together(const Eigen::VectorXd& innovation, const Eigen::MatrixXd& S,
                                  std::vector<bool> passed, std::span<const int> ranks = {}) const;

 private:
  std::optional<std::array<double, 4>> thresholds_;  ///< by rank
  std::optional<double> joint_probability_;
};

/// So many registrations at most are searched for the best set (2¹² sets); of more, the worst are
/// dropped. It bounds the time: sets of that size agree or differ by far.
inline constexpr std::size_t kMostSearched = 12;

/// The largest set of m candidates whose joint νᵀ S⁻¹ ν is within the χ² quantile of `probability`
/// with 3 m degrees of freedom; of several as large, that with the least (joint compatibility,
/// Neira and Tardos 2001). `innovation` stacks 3 numbers a registration, S is its covariance, with
/// the correlation that the state brings: loops that agree by themselves may disagree with each
/// other. Branch and bound up to kMostSearched candidates; from more, the one whose removal lowers
/// the joint value most is dropped until the rest passes. `ranks`: degrees of freedom of each,
/// where they are not 3; its other rows are zero in the innovation and uncorrelated (LoopRows).
std::vector<bool> jointly_compatible(const Eigen::VectorXd& innovation, const Eigen::MatrixXd& S,
                                     const std::vector<bool>& candidates, double probability,
                                     std::span<const int> ranks = {});

/// νᵀ S⁻¹ ν of some of the registrations of a stack; infinite where their S is not positive
/// definite.
double joint_nis(const Eigen::VectorXd& innovation, const Eigen::MatrixXd& S,
                 const std::vector<std::size_t>& chosen);

/// Whether every registration's NIS, where there is one, is a number.
bool has_finite_nis(const UpdateReport& report);

/// What the gate's answer makes of a registration.
LoopFate fate_of(bool passes);

/// Marks an update that failed: what its gate let through is lost.
void lose_all(UpdateReport& report, Outcome outcome);

/// H P Hᵀ for each of some loops that are written forward and end at the newest keyframe: the
/// covariance that the estimate gives h(x); nothing where they cannot be computed. With that of the
/// measurement added it is that of the innovation.
using PredictedCovariances = std::function<std::optional<std::vector<Eigen::Matrix3d>>(
    std::span<const RelativePose> forward)>;

/// Decides on every loop of an update, in report.loops; covariances are asked for only where the
/// gate is on. False where they cannot be judged: a number is not finite, beyond what doubles
/// resolve (are_resolved), or there is no covariance.
bool judge(const Gate& gate, const TrajectoryView& estimate,
           std::span<const RelativePose> registrations, const PredictedCovariances& covariances,
           UpdateReport& report);

/// The update of an estimator that minimises over a whole graph: each registration is judged, those
/// that are used go to `minimise`, and they are lost where that fails. `minimise` adds them and
/// minimises, or keeps them for a batch solve; where it fails, it leaves the graph as it was.
/// `as_judged`: each registration as its innovation is to be tested; none: as it is.
UpdateReport judged_update(
    const Gate& gate, const TrajectoryView& estimate, std::span<const RelativePose> registrations,
    const PredictedCovariances& covariances,
    const std::function<UpdateReport(std::span<const RelativePose> used)>& minimise,
    std::span<const RelativePose> as_judged = {});

/// νᵀ S⁻¹ ν; NaN where S is not positive definite.
double normalised_innovation_squared(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& S);

}  // namespace fathom
