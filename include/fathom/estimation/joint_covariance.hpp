#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

/// What every estimator needs for Estimator::joint_covariance, whatever its method.
namespace fathom {

/// The keyframes but 0, rising, each once: those that a joint covariance has to be computed of.
std::vector<std::size_t> free_keyframes(std::span<const std::size_t> keyframes);

/// The 3m×3m joint covariance of m keyframes in the order given, zero for keyframe 0, from that of
/// free_keyframes(keyframes) in theirs, 3u×3u. Of that only the upper triangle is read, so that the
/// result is symmetric to the last bit.
Eigen::MatrixXd in_order_of(std::span<const std::size_t> keyframes, const Eigen::MatrixXd& joint);

}  // namespace fathom
