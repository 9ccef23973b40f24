// What the Ceres problem's Jacobian says: covariances of poses and motions, and whether it carries
// all measurements.

#include <algorithm>
#include <utility>

#include <ceres/crs_matrix.h>

#include "estimators/ceres_pose_graph/graph.hpp"
#include "estimators/ceres_pose_graph/hessian_inverse.hpp"
#include "fathom/estimation/joint_covariance.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

// A step that promises less, half of squared sigmas, is one of rounding.
constexpr double kRoundingCost = 1e-12;

}  // namespace

std::optional<std::vector<Eigen::Matrix3d>> CeresPoseGraph::Graph::predicted_covariances(
    std::span<const RelativePose> forward_loops) {
  const auto estimates = [this](const RelativePose& z) { return estimates_errors(z); };
  if (std::ranges::any_of(forward_loops, estimates)) return predicted_with_errors(forward_loops);
  std::vector<std::size_t> ends;
  for (const RelativePose& z : forward_loops) ends.insert(ends.end(), {z.from, z.to});
  const auto joint = joint_covariance(ends);
  if (!joint) return std::nullopt;
  std::vector<Eigen::Matrix3d> predicted;
  for (const RelativePose& z : forward_loops) {
    const auto row = static_cast<Eigen::Index>(6 * predicted.size());
    const PairCovariance pair{joint->block<3, 3>(row, row), joint->block<3, 3>(row + 3, row + 3),
                              joint->block<3, 3>(row, row + 3)};
    predicted.push_back(between(pose(z.from), pose(z.to), pair).covariance);
  }
  return predicted;
}

void CeresPoseGraph::Graph::compute_marginals() {
  marginals_.emplace();
  if (size() > 1) {
    const auto J = jacobian();
    const auto blocks = J ? inverse_blocks(*J, size() - 1) : std::nullopt;
    if (!blocks) return;
    *marginals_ = blocks->own;
  }
  marginals_->insert(marginals_->begin(), Eigen::Matrix3d::Zero());
}

std::optional<Eigen::Matrix3d> CeresPoseGraph::Graph::marginal(std::size_t k) {
  if (!marginals_) compute_marginals();
  if (marginals_->empty()) return std::nullopt;
  return (*marginals_)[k];
}

std::optional<Eigen::MatrixXd> CeresPoseGraph::Graph::joint_covariance(
    std::span<const std::size_t> keyframes) {
  std::vector<std::size_t> blocks = free_keyframes(keyframes);
  if (blocks.empty()) return in_order_of(keyframes, {});
  for (std::size_t& block : blocks) --block;  // of the Hessian, which has none for keyframe 0
  const auto J = jacobian();
  const auto joint = J ? inverse_between(*J, blocks) : std::nullopt;
  if (!joint) return std::nullopt;
  return in_order_of(keyframes, *joint);
}

ceres::Problem::EvaluateOptions CeresPoseGraph::Graph::free_blocks() {
  ceres::Problem::EvaluateOptions evaluate;
  evaluate.num_threads = 1;
  for (std::size_t k = 1; k < size(); ++k) evaluate.parameter_blocks.push_back(block(k));
  for (Block& errors : unknowns_.errors) evaluate.parameter_blocks.push_back(errors.data());
  return evaluate;
}

// Of the free blocks, the loss applied as a weight. Nothing where it is not finite, of which Ceres
// would print a warning.
std::unique_ptr<const Eigen::SparseMatrix<double>> CeresPoseGraph::Graph::jacobian() {
  if (!is_finite()) return nullptr;
  ceres::CRSMatrix J;
  if (!problem_.Evaluate(free_blocks(), nullptr, nullptr, nullptr, &J)) return nullptr;
  return std::make_unique<const Eigen::SparseMatrix<double>>(
      Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(
          J.num_rows, J.num_cols, static_cast<Eigen::Index>(J.values.size()), J.rows.data(),
          J.cols.data(), J.values.data()));
}

std::optional<std::vector<UncertainPose>> CeresPoseGraph::Graph::motions_to_newest() {
  std::vector<UncertainPose> motions;
  const std::size_t n = size() - 1;
  if (n == 0) return motions;
  const auto J = jacobian();
  const auto blocks = J ? inverse_blocks(*J, n) : std::nullopt;
  if (!blocks) return std::nullopt;
  PairCovariance pair;
  pair.B = blocks->own[n - 1];
  for (std::size_t k = 0; k < n; ++k) {
    if (k > 0) {
      pair.A = blocks->own[k - 1];
      pair.cross = blocks->with_last[k - 1];
    }
    motions.push_back(between(pose(k), pose(n), pair));
  }
  return motions;
}

// Measurements that are alike in their information always are.
bool CeresPoseGraph::Graph::is_determined(Factors factors) {
  if (!spread_.is_wide()) return true;
  const auto J = jacobian();
  return J && (factors == Factors::sums ? keeps_digits(*J) : fathom::is_determined(*J));
}

// Where a step of some directions is known to metres alone, one from the minimum promises rounding,
// less than nothing as often as more, which Ceres calls an invalid step. It is not known from a
// factor that fails but here.
bool CeresPoseGraph::Graph::is_at_minimum(Factors factors) {
  const auto J = jacobian();
  if (!J) return false;
  double cost = 0.0;
  std::vector<double> all;
  problem_.Evaluate(free_blocks(), &cost, &all, nullptr, nullptr);
  const Eigen::Map<const Eigen::VectorXd> residuals(all.data(), J->rows());
  const auto left =
      factors == Factors::sums ? decrease_of_step(*J, residuals) : decrease_by_rows(*J, residuals);
  const double rounding = factors == Factors::sums ? 0.0 : kRoundingCost;
  return left && *left <= options_.tolerance * cost + rounding;
}

}  // namespace fathom
