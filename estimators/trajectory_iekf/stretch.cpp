#include "estimators/trajectory_iekf/stretch.hpp"

#include <algorithm>
#include <cmath>

#include "fathom/geometry/trajectory.hpp"

namespace fathom {

Stretch::Stretch(std::size_t first, std::span<const Pose> motions)
    : first_(first), poses_(compose_trajectory(Pose{}, motions)) {}

Pose Stretch::h(std::size_t from) const {
  return between(poses_[from - first_], poses_.back());
}

// A translation of motion i acts along the axes of keyframe i − 1; a turn swings the rest of the
// stretch, from keyframe i to n, about keyframe i.
Eigen::MatrixX3d Stretch::A_transposed() const {
  const std::size_t n = poses_.size() - 1;
  Eigen::MatrixX3d A(static_cast<Eigen::Index>(3 * n), 3);
  for (std::size_t i = 1; i <= n; ++i) {
    const auto row = static_cast<Eigen::Index>(3 * (i - 1));
    const double c = std::cos(poses_[i - 1].theta);
    const double s = std::sin(poses_[i - 1].theta);
    A.row(row) << c, s, 0.0;
    A.row(row + 1) << -s, c, 0.0;
    A.row(row + 2) << poses_[i].y - poses_[n].y, poses_[n].x - poses_[i].x, 1.0;
  }
  return A;
}

Eigen::Matrix3d Stretch::D(std::size_t from) const {
  Eigen::Matrix3d D = Eigen::Matrix3d::Identity();
  D.topLeftCorner<2, 2>() = rotation(poses_[from - first_].theta);
  return D;
}

Eigen::Matrix3Xd Stretch::H(std::size_t from) const {
  Eigen::Matrix3Xd H = D(from).transpose() * A_transposed().transpose();
  H.leftCols(static_cast<Eigen::Index>(3 * (from - first_))).setZero();
  return H;
}

StackedJacobian::StackedJacobian(const Stretch& stretch, std::span<const Rows> registrations)
    : A_transposed_(stretch.A_transposed()) {
  for (const Rows& z : registrations) starts_.push_back(static_cast<Eigen::Index>(z.from));
  std::sort(starts_.begin(), starts_.end());
  starts_.erase(std::unique(starts_.begin(), starts_.end()), starts_.end());
  E_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * starts_.size()),
                             static_cast<Eigen::Index>(3 * registrations.size()));
  Eigen::Index column = 0;
  for (const Rows& z : registrations) {
    const auto start =
        std::lower_bound(starts_.begin(), starts_.end(), static_cast<Eigen::Index>(z.from));
    auto D = E_.block<3, 3>(3 * (start - starts_.begin()), column);
    D = stretch.D(z.from);
    if (z.C != nullptr) D = (D * z.C->transpose()).eval();
    column += 3;
  }
}

// A X over the motions from each start on, segment after segment from the last; then Eᵀ of it.
Eigen::MatrixXd StackedJacobian::times(const Eigen::Ref<const Eigen::MatrixXd>& X) const {
  Eigen::MatrixXd sums(E_.rows(), X.cols());
  Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, X.cols());
  Eigen::Index end = X.rows();
  for (std::size_t s = starts_.size(); s-- > 0;) {
    const Eigen::Index rows = end - row_of(s);
    sum.noalias() +=
        A_transposed_.middleRows(row_of(s), rows).transpose() * X.middleRows(row_of(s), rows);
    sums.middleRows<3>(static_cast<Eigen::Index>(3 * s)) = sum;
    end = row_of(s);
  }
  return E_.transpose() * sums;
}

Eigen::VectorXd StackedJacobian::transposed_times(const Eigen::VectorXd& lambda) const {
  const Eigen::VectorXd E_lambda = E_ * lambda;
  Eigen::VectorXd product(A_transposed_.rows());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t s = 0; s < starts_.size(); ++s) {
    sum += E_lambda.segment<3>(static_cast<Eigen::Index>(3 * s));
    const Eigen::Index end = s + 1 < starts_.size() ? row_of(s + 1) : product.size();
    const Eigen::Index rows = end - row_of(s);
    product.segment(row_of(s), rows).noalias() = A_transposed_.middleRows(row_of(s), rows) * sum;
  }
  return product;
}

}  // namespace fathom
