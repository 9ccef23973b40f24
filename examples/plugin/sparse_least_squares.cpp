// A plug-in with one estimator: the pose graph solved anew at each update, by Gauss-Newton with
// Eigen's sparse Cholesky factorisation. It is correct and short, and slower than those built in.

#include <memory>

#include <Eigen/SparseCholesky>

#include "fathom/estimation/gate.hpp"
#include "fathom/estimation/joint_covariance.hpp"
#include "fathom/estimation/plugin.hpp"
#include "fathom/estimation/precision.hpp"
#include "fathom/estimation/relative_estimator.hpp"

namespace {

using namespace fathom;

struct Options {
  int max_iterations = 20;  // the initialiser is the default, and its only place
  double tolerance = 1e-6;
  GateOptions gate;  // gate_probability

  void describe(OptionTable& table) {
    table.integer("max_iterations", max_iterations, Range::at_least(1), "",
                  "linearisations of one update at most");
    table.real("tolerance", tolerance, Range::positive(), "m, rad", "step that ends an update");
    gate.describe(table);
  }
};

// Keyframe 0 is fixed and has no rows.
int row_of(std::size_t k) {
  return 3 * (static_cast<int>(k) - 1);
}

using Sparse = Eigen::SparseMatrix<double>;
using Factor = Eigen::SimplicialLDLT<Sparse>;

// Positive definite, and no pivot but what rounding leaves.
bool is_definite(const Factor& factor, const Sparse& H) {
  if (factor.info() != Eigen::Success) return false;
  const Eigen::VectorXd sums = factor.permutationP() * H.diagonal();
  return (factor.vectorD().array() > kLeastPivotShare * sums.array()).all();
}

struct NormalEquations {
  Sparse H;
  Eigen::VectorXd gradient;

  NormalEquations(const std::vector<RelativePose>& edges, const std::vector<Pose>& poses)
      : H(row_of(poses.size()), row_of(poses.size())),
        gradient(Eigen::VectorXd::Zero(row_of(poses.size()))) {
    std::vector<Eigen::Triplet<double>> entries;
    for (const RelativePose& edge : edges) {
      Eigen::Matrix3d J[2];
      const Eigen::Vector3d e =
          residual(edge.motion, poses[edge.from], poses[edge.to], &J[0], &J[1]);
      const std::size_t ends[2] = {edge.from, edge.to};
      for (int a = 0; a < 2; ++a) {
        if (ends[a] == 0) continue;
        const Eigen::Matrix3d weighted = J[a].transpose() * edge.information;
        gradient.segment<3>(row_of(ends[a])) += weighted * e;
        for (int b = 0; b < 2; ++b) {
          if (ends[b] == 0) continue;
          const Eigen::Matrix3d block = weighted * J[b];
          for (int i = 0; i < 9; ++i) {
            entries.emplace_back(row_of(ends[a]) + i % 3, row_of(ends[b]) + i / 3, block(i));
          }
        }
      }
    }
    H.setFromTriplets(entries.begin(), entries.end());
  }
};

class SparseLeastSquares final : public RelativeEstimator {
 public:
  SparseLeastSquares(const EstimatorSetup& setup, const Options& options)
      : options_(options), gate_(options.gate), poses_{setup.start.pose} {}

  std::size_t size() const override { return poses_.size(); }
  Pose pose(std::size_t k) const override { return poses_[k]; }

  void add_keyframe(const RelativePose& step) override {
    edges_.push_back(step);
    poses_.push_back(compose(poses_.back(), step.forward().motion));
  }

  UpdateReport close_loops(std::span<const RelativePose> registrations) override {
    return judged_update(
        gate_, *this, registrations, [this](auto loops) { return predicted_covariances(loops); },
        [this](auto used) { return minimise_with(used); });
  }

  // A hole in dead reckoning: what is behind it moves as one, and its edge with it.
  std::optional<LoopDecision> bridge(const Bridge& bridge) override {
    for (std::size_t k = 0; k < size(); ++k) {
      if (bridge.moves[k]) poses_[k] = compose(bridge.motion, poses_[k]);
    }
    for (RelativePose& edge : edges_) {
      if (!edge.is_hole || bridge.moves[edge.from] == bridge.moves[edge.to]) continue;
      edge.motion = between(poses_[edge.from], poses_[edge.to]);
    }
    return std::nullopt;
  }

  std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> keyframes) const override {
    const std::vector<std::size_t> free = free_keyframes(keyframes);
    if (free.empty()) return in_order_of(keyframes, {});
    const NormalEquations equations(edges_, poses_);
    const Factor H(equations.H);
    if (!is_definite(H, equations.H)) return std::nullopt;
    Eigen::MatrixXd selected =
        Eigen::MatrixXd::Zero(H.rows(), static_cast<Eigen::Index>(3 * free.size()));
    for (std::size_t j = 0; j < free.size(); ++j) {
      selected.block<3, 3>(row_of(free[j]), static_cast<Eigen::Index>(3 * j)).setIdentity();
    }
    return in_order_of(keyframes, selected.transpose() * H.solve(selected));
  }

 private:
  // As it was before where that fails.
  UpdateReport minimise_with(std::span<const RelativePose> loops) {
    std::vector<RelativePose> edges = edges_;
    edges.insert(edges.end(), loops.begin(), loops.end());
    std::vector<Pose> poses = poses_;
    UpdateReport report;
    report.outcome = minimise(edges, poses, report.iterations);
    if (!is_done(report.outcome)) return report;
    edges_ = std::move(edges);
    poses_ = std::move(poses);
    return report;
  }

  Outcome minimise(const std::vector<RelativePose>& edges, std::vector<Pose>& poses,
                   int& iterations) const {
    for (iterations = 1; iterations <= options_.max_iterations; ++iterations) {
      const NormalEquations equations(edges, poses);
      const Factor H(equations.H);
      if (!is_definite(H, equations.H)) return Outcome::numerical_failure;
      const Eigen::VectorXd step = -H.solve(equations.gradient);
      if (!step.allFinite()) return Outcome::numerical_failure;
      for (std::size_t k = 1; k < poses.size(); ++k) {
        const Eigen::Vector3d moved = poses[k].vector() + step.segment<3>(row_of(k));
        poses[k] = {moved.x(), moved.y(), wrap_angle(moved.z())};
      }
      if (step.lpNorm<Eigen::Infinity>() < options_.tolerance) return Outcome::converged;
    }
    --iterations;
    return Outcome::iteration_limit;
  }

  std::optional<std::vector<Eigen::Matrix3d>> predicted_covariances(
      std::span<const RelativePose> forward) const {
    const auto motions = motions_to_newest();
    if (!motions) return std::nullopt;
    std::vector<Eigen::Matrix3d> covariances;
    for (const RelativePose& z : forward) covariances.push_back((*motions)[z.from].covariance);
    return covariances;
  }

  Options options_;
  Gate gate_;
  std::vector<RelativePose> edges_;
  std::vector<Pose> poses_;
};

void add_estimators(EstimatorRegistry& registry) {
  registry.add(make_relative_entry<Options>(
      "sparse_least_squares", "pose-graph least squares by Eigen's sparse Cholesky factorisation",
      false, [](const EstimatorSetup& setup, const Options& options) {
        return std::make_unique<SparseLeastSquares>(setup, options);
      }));
}

}  // namespace

FATHOM_PLUGIN(add_estimators)
