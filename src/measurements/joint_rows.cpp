#include "joint_rows.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "fathom/core/disjoint_sets.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

bool is_used(const std::vector<bool>& used, std::size_t registration) {
  return used.empty() || used[registration];
}

// What ties the poses: measured steps, registrations in use, and, as the number of keyframes,
// the world.
DisjointSets ties_of(const MeasurementLog& log, const std::vector<bool>& used) {
  const std::size_t world = log.size();
  DisjointSets ties(log.size() + 1);
  if (!log.start().is_free) ties.join(0, world);
  std::size_t registration = 0;
  for (std::size_t k = 0; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    if (k > 0 && !arrival.step.is_hole) ties.join(k - 1, k);
    for (const RelativePose& z : arrival.registrations) {
      if (is_used(used, registration++)) ties.join(z.from, z.to);
    }
    for (const AbsolutePose& z : arrival.absolute) {
      if (rank_of(z.information) == 3) ties.join(k, world);
    }
  }
  return ties;
}

bool has_absolute(const MeasurementLog& log) {
  return log.absolute_count() > 0;
}

}  // namespace

// A hole that alone ties its two sides is counted: three measurements for three unknowns, which
// leaves the restricted likelihood as it is but for a constant. So does keyframe 0, held where
// nothing says where it is.
JointRows::JointRows(const MeasurementLog& log, std::span<const Pose> trajectory,
                     const std::vector<bool>& used)
    : is_first_held_(log.start().is_fixed() || (log.start().is_free && !has_absolute(log))),
      poses_(3 * static_cast<Index>(log.size() - (is_first_held_ ? 1 : 0))),
      unknowns_(poses_),
      picture_(log.size(), -1),
      sigma_of_(log.size(), Eigen::Vector3d::Zero()) {
  DisjointSets ties = ties_of(log, used);
  if (!log.start().is_fixed() && !log.start().is_free) {
    add(log.start().measurement(), trajectory[0]);
  }
  for (std::size_t k = 0; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    if (k > 0 && (!arrival.step.is_hole || ties.root(k - 1) != ties.root(k))) {
      ties.join(k - 1, k);
      add(arrival.step, trajectory);
    }
    for (const RelativePose& z : arrival.registrations) {
      const bool is_left_out = !is_used(used, registrations_.size());
      registrations_.push_back(is_left_out ? -1 : static_cast<Index>(residuals_.size()));
      if (!is_left_out) add(z, trajectory);
    }
    for (const AbsolutePose& z : arrival.absolute) add(z, trajectory[k]);
  }
  B_.resize(static_cast<Index>(residuals_.size()), unknowns_);
  B_.setFromTriplets(elements_.begin(), elements_.end());
  c_ = Eigen::Map<const Eigen::VectorXd>(residuals_.data(), B_.rows());
}

// e = −Dᵀ ν with D the rotation of z, so that what is left of it without the pictures' errors is
// e + Dᵀ G n, of covariance Dᵀ own D (docs/conventions.md).
void JointRows::add(const RelativePose& z, std::span<const Pose> trajectory) {
  Eigen::Matrix3d J_from;
  Eigen::Matrix3d J_to;
  const Eigen::Vector3d e =
      residual(z.motion, trajectory[z.from], trajectory[z.to], &J_from, &J_to);
  std::vector<Block> blocks{{pose_column(z.from), J_from}, {pose_column(z.to), J_to}};
  Eigen::Matrix3d information = z.information;
  if (z.shared) {
    const Eigen::Matrix3d back = planar_rotation(z.motion.theta).transpose();
    information = symmetric_inverse(transport(back, z.shared->own));
    blocks.push_back({picture_column(z.from, z.shared->from), back * z.shared->from.G});
    blocks.push_back({picture_column(z.to, z.shared->to), back * z.shared->to.G});
    told_.push_back(static_cast<Index>(residuals_.size()));
  }
  const Eigen::LLT<Eigen::Matrix3d> factor(information);
  const Eigen::Matrix3d whiten = factor.matrixU();
  for (Block& block : blocks) block.J = whiten * block.J;
  log_own_ -= 2.0 * whiten.diagonal().array().log().sum();
  if (factor.info() != Eigen::Success) log_own_ = std::numeric_limits<double>::quiet_NaN();
  add_rows(whiten * e, blocks, 3);
}

void JointRows::add(const AbsolutePose& z, const Pose& X) {
  Eigen::Matrix3d J;
  const Eigen::Vector3d e = residual(z, X, &J);
  const InformationRows measured = rows_of(z.information);
  const Eigen::Vector3d weights = measured.variances.cwiseSqrt().cwiseInverse();
  const Eigen::Matrix3d whiten = weights.asDiagonal() * measured.rows;
  log_own_ += measured.variances.head(measured.rank).array().log().sum();
  const std::array blocks{Block{pose_column(z.keyframe), whiten * J}};
  add_rows(whiten * e, blocks, measured.rank);
}

void JointRows::add_rows(const Eigen::Vector3d& e, std::span<const Block> blocks, int rows) {
  const auto first = static_cast<Index>(residuals_.size());
  for (const Block& block : blocks) {
    if (block.column < 0) continue;
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < 3; ++j) {
        elements_.emplace_back(first + i, block.column + j, block.J(i, j));
      }
    }
  }
  for (int i = 0; i < rows; ++i) residuals_.push_back(e[i]);
}

JointRows::Index JointRows::pose_column(std::size_t k) const {
  return 3 * (static_cast<Index>(k) - (is_first_held_ ? 1 : 0));
}

JointRows::Index JointRows::picture_column(std::size_t k, const PictureErrors& errors) {
  if (picture_[k] < 0) {
    picture_[k] = unknowns_;
    sigma_of_[k] = errors.sigma;
    unknowns_ += 3;
  }
  return picture_[k];
}

std::optional<JointRows::Index> JointRows::picture(std::size_t k) const {
  if (picture_[k] < 0) return std::nullopt;
  return picture_[k];
}

bool JointRows::is_finite() const {
  const Eigen::Map<const Eigen::VectorXd> elements(B_.valuePtr(), B_.nonZeros());
  return std::isfinite(log_own_) && c_.allFinite() && elements.allFinite();
}

std::vector<Pose> JointRows::moved(std::span<const Pose> trajectory,
                                   const Eigen::VectorXd& y) const {
  std::vector<Pose> poses(trajectory.begin(), trajectory.end());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (pose_column(k) < 0) continue;
    poses[k] = Pose::from_vector(poses[k].vector() + y.segment<3>(pose_column(k)));
    poses[k].theta = wrap_angle(poses[k].theta);
  }
  return poses;
}

}  // namespace fathom
