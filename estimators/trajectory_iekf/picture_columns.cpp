// What the covariance of a state that has errors of pictures needs beside that of motions.

#include "estimators/trajectory_iekf/motion_covariance.hpp"

namespace fathom {

void MotionCovariance::replace(Eigen::Index i, const Eigen::MatrixX3d& column) {
  fold();
  dense_.replace(i, column);
}

Eigen::MatrixXd MotionCovariance::products(std::span<const Eigen::Index> blocks,
                                           const Eigen::MatrixXd& B) const {
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(size(), B.cols());
  const auto rows_of = [&](std::size_t b) {
    return B.middleRows<3>(static_cast<Eigen::Index>(3 * b));
  };
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (blocks[b] < dense_motions()) {
      product.topRows(dense_.size()).noalias() += dense_.column(blocks[b]) * rows_of(b);
    } else {
      product.middleRows<3>(3 * blocks[b]) =
          later_[static_cast<std::size_t>(blocks[b] - dense_motions())] * rows_of(b);
    }
  }
  for (const filter::DowndateFactor& factor : factors_.factors()) {
    Eigen::MatrixXd VtB = Eigen::MatrixXd::Zero(factor.V.cols(), B.cols());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const Eigen::Index row = 3 * blocks[b] - factor.first_row;
      if (row < 0 || row >= factor.V.rows()) continue;
      VtB.noalias() += factor.V.middleRows<3>(row).transpose() * rows_of(b);
    }
    product.middleRows(factor.first_row, factor.V.rows()).noalias() -= factor.V * VtB;
  }
  return product;
}

void MotionCovariance::downdate_but(std::span<const Eigen::Index> kept,
                                    const Eigen::Ref<const Eigen::MatrixXd>& V) {
  fold();
  Eigen::MatrixXd of_all = Eigen::MatrixXd::Zero(size(), V.cols());
  of_all.bottomRows(V.rows()) = V;
  dense_.downdate_but(kept, of_all);
}

}  // namespace fathom
