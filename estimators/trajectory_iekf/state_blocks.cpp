#include "estimators/trajectory_iekf/state_blocks.hpp"

namespace fathom {

Eigen::MatrixX3d StateBlocks::spread(Eigen::MatrixX3d motions, std::size_t first,
                                     Eigen::Index begin) const {
  if (are_motions_alone()) return motions;
  Eigen::MatrixX3d state = Eigen::MatrixX3d::Zero(3 * (size() - begin), 3);
  for (std::size_t i = first; i < motions_.size(); ++i) {
    state.middleRows<3>(3 * (motions_[i] - begin)) =
        motions.middleRows<3>(static_cast<Eigen::Index>(3 * (i - first)));
  }
  return state;
}

Eigen::VectorXd StateBlocks::motions_in(const Eigen::VectorXd& state, std::size_t first) const {
  if (are_motions_alone()) return state;
  const Eigen::Index begin = size() - state.size() / 3;
  Eigen::VectorXd motions(static_cast<Eigen::Index>(3 * (motions_.size() - first)));
  for (std::size_t i = first; i < motions_.size(); ++i) {
    motions.segment<3>(static_cast<Eigen::Index>(3 * (i - first))) =
        state.segment<3>(3 * (motions_[i] - begin));
  }
  return motions;
}

std::vector<Eigen::Matrix3d> StateBlocks::motions_in(std::vector<Eigen::Matrix3d> sums) const {
  if (are_motions_alone()) return sums;
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    sums[i] = sums[static_cast<std::size_t>(motions_[i])];
  }
  sums.resize(motions_.size());
  return sums;
}

Eigen::MatrixXd PictureJacobian::times(const Eigen::Ref<const Eigen::MatrixXd>& X,
                                       Eigen::Index begin) const {
  Eigen::MatrixXd own(G.cols(), X.cols());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    own.middleRows<3>(static_cast<Eigen::Index>(3 * b)) = X.middleRows<3>(3 * (blocks[b] - begin));
  }
  return G * own;
}

}  // namespace fathom
