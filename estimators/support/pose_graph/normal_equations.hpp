#pragma once

#include <optional>
#include <span>
#include <vector>

#include "estimators/support/pose_graph/edge_parts.hpp"
#include "estimators/support/pose_graph/pair_terms.hpp"
#include "estimators/support/sparse/block_cholesky.hpp"

namespace fathom::pose_graph {

/// Who is linked with whom among nodes 1 …, in the pattern one less: 0 is fixed. The edges may
/// share errors of pictures, which are among the nodes.
sparse::Symbolic analyse_graph(std::span<const Edge> edges, int nodes, Workers* workers = nullptr,
                               sparse::ChainElimination chains = sparse::ChainElimination::on);

/// Whether a step is small beside the estimate.
bool is_small(double squared_step, std::span<const Node> nodes, double tolerance);

/// The matrix and gradient of ½F at an estimate, and the factor of the matrix. Of the errors of
/// pictures, nodes behind the keyframes, F has nᵀ n.
class NormalEquations {
 public:
  /// The edges must outlive it.
  NormalEquations(const sparse::Symbolic& symbolic, std::span<const Edge> edges);

  /// A loss on some edges from now on; F is then Σ ρ(νᵀ W ν). What it covers must outlive this.
  void set_loss(const EdgeLoss& loss) { loss_ = loss; }
  const EdgeLoss& loss() const { return loss_; }

  /// Adds both up at the estimate; the diagonal is multiplied by 1 + damping. Returns F. The first
  /// edges add what `given` has of them in place of their own terms. Hessian::positions is for
  /// graphs without errors of pictures.
  double linearise(std::span<const Node> nodes, Hessian hessian, double damping = 0.0,
                   std::span<const PairTerms> given = {});

  /// The gradient alone; the factor stays that of another estimate. Returns F.
  double differentiate(std::span<const Node> nodes, std::span<const PairTerms> given = {});

  bool factorise(sparse::Inertia inertia = sparse::Inertia::any);
  int negative_pivots() const { return factor_.negative_pivots(); }
  /// Factorises the Gauss-Newton matrix at an estimate. Whether it is positive definite and no
  /// pivot is but rounding (kLeastPivotShare), nor any W (WideRows).
  bool factorise_at(std::span<const Node> nodes);

  /// x ← H⁻¹ x; nodes in the order of elimination.
  void solve(double* x) { factor_.solve(x); }
  /// −H⁻¹ g, with the matrix that was factored last; nodes in the order of elimination.
  const std::vector<double>& solve_step();
  /// Iterations of solve_near that cost as much as a factorisation; 0: there is no factor, or the
  /// graph has errors of pictures.
  int iterations_worth_a_factor() const;
  /// The Gauss-Newton step at an estimate by conjugate gradients (Hestenes and Stiefel 1952), with
  /// the factor at hand, which is of another estimate, as the preconditioner. Returns F at the
  /// estimate; nothing where the step has not settled in so many iterations.
  std::optional<double> solve_near(std::span<const Node> nodes, int most_iterations,
                                   std::span<const PairTerms> given = {});
  /// The Gauss-Newton step from the whitened rows of all measurements, without the sums of the
  /// matrix and the gradient (sparse::eliminate_rows), for graphs that those do not carry; without
  /// a loss. The factor of Jᵀ W J is left in factor(). Returns by how much F would fall if it were
  /// quadratic; nothing where a pivot is but rounding.
  std::optional<double> solve_rows(std::span<const Node> nodes);
  void halve_step();
  /// gᵀ H⁻¹ g of the last step: by how much F would fall if it were quadratic.
  double predicted_decrease() const;
  /// Largest absolute element of the gradient of F.
  double gradient_norm() const;

  /// The estimate moved by the last step; `to` may be where it is.
  void move(std::span<const Node> from, std::vector<Node>& to) const;
  /// Whether every number of the last step is small beside that of the estimate.
  bool step_is_small(std::span<const Node> nodes, double tolerance) const;

  std::span<const Edge> edges() const { return edges_; }
  sparse::BlockCholesky<3>& factor() { return factor_; }
  /// ½ ∂F/∂x; nodes in the order of elimination.
  const std::vector<double>& gradient() const { return gradient_; }
  /// The last step, in the same order.
  const std::vector<double>& step() const { return step_; }

 private:
  /// Where an edge's terms go.
  struct Targets {
    int from = -1;  ///< position, −1 of the fixed keyframe
    int to = -1;
    sparse::BlockPlace cross;
  };

  /// Where the terms of the errors that an edge shares go: positions and places; −1: of no picture.
  struct SharedTargets {
    struct End {
      int position = -1;
      sparse::BlockPlace with_from;
      sparse::BlockPlace with_to;
    };
    std::size_t edge = 0;
    End from;
    End to;
    sparse::BlockPlace between;
  };

  void find_shared(const sparse::Symbolic& symbolic);
  double add_shared(std::span<const Node> nodes, Hessian hessian);
  void add_shared_gradients(std::span<const Node> nodes);
  void add_shared_gradient(const EdgeTerms& t, const Eigen::Matrix3d& A, int position);
  void add_shared_end(const EdgeTerms& t, const Eigen::Matrix3d& A, const Targets& target,
                      const SharedTargets::End& end);
  double add_priors(std::span<const Node> nodes, bool with_matrix);
  void add_block(sparse::BlockPlace place, int row, int column, const Eigen::Matrix3d& block);
  template <Hessian kHessian>
  double add_edges(std::span<const Node> nodes, std::span<const PairTerms> given);
  template <class Part>
  void add_gradient(const PairTerms& t, const Part& part, const Targets& target);
  template <class Part>
  void add_matrix(const PairTerms& t, const Part& part, const Targets& target);
  void write_diagonal(double damping);
  // to = Jᵀ W J v.
  void multiply(std::span<const Node> nodes, std::span<const PairTerms> given,
                const std::vector<double>& v, std::vector<double>& to) const;
  bool keeps_digits() const;
  Workers* workers() const { return factor_.symbolic().workers; }

  std::span<const Edge> edges_;
  EdgeLoss loss_;
  EdgeParts parts_;
  sparse::BlockCholesky<3> factor_;
  std::vector<Targets> targets_;
  std::vector<SharedTargets> shared_;
  std::vector<sparse::BlockPlace> diagonal_;  ///< by position
  std::vector<std::array<double, 6>> diagonal_sums_;
  std::vector<double> gradient_;
  std::vector<double> step_;
  bool has_factor_ = false;      ///< of a positive definite matrix
  bool has_begun_step_ = false;  ///< factorise() has, for the gradient as it is
};

/// F as cost_of, by the rows of NormalEquations::solve_rows: where W of an edge is wide itself its
/// rows keep more digits than νᵀ W ν.
double whitened_cost(std::span<const Edge> edges, std::span<const Node> nodes);

/// A = diag(Rot(θ_from), 1) G: what an error of a picture does to ν, world axes.
Eigen::Matrix3d in_world(const Eigen::Matrix3d& G, const Node& from);

}  // namespace fathom::pose_graph
