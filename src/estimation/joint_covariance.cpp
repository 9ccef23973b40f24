#include "fathom/estimation/joint_covariance.hpp"

#include <algorithm>

namespace fathom {

std::vector<std::size_t> free_keyframes(std::span<const std::size_t> keyframes) {
  std::vector<std::size_t> free(keyframes.begin(), keyframes.end());
  std::erase(free, 0);
  std::sort(free.begin(), free.end());
  free.erase(std::unique(free.begin(), free.end()), free.end());
  return free;
}

Eigen::MatrixXd in_order_of(std::span<const std::size_t> keyframes, const Eigen::MatrixXd& joint) {
  const std::vector<std::size_t> free = free_keyframes(keyframes);
  const auto row_of = [&](std::size_t keyframe) {
    return 3 * (std::lower_bound(free.begin(), free.end(), keyframe) - free.begin());
  };
  const Eigen::MatrixXd whole = joint.selfadjointView<Eigen::Upper>();
  const auto size = static_cast<Eigen::Index>(3 * keyframes.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    for (std::size_t j = 0; j < keyframes.size(); ++j) {
      if (keyframes[i] == 0 || keyframes[j] == 0) continue;
      result.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j)) =
          whole.block<3, 3>(row_of(keyframes[i]), row_of(keyframes[j]));
    }
  }
  return result;
}

}  // namespace fathom
