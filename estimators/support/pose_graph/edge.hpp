#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <numbers>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/support/sparse/index.hpp"
#include "fathom/estimation/robust_loss.hpp"
#include "fathom/measurements/relative_pose.hpp"

namespace fathom::pose_graph {

using sparse::at;

/// What the errors of its two pictures do to a registration, where they are unknowns of the graph
/// (PictureStates): ν = h − z + G_from n_from + G_to n_to, n in units of their standard deviations.
struct SharedEnds {
  struct End {
    int node = -1;  ///< whose x, y, θ are n; −1: of this picture nothing is shared
    Eigen::Matrix3d G = Eigen::Matrix3d::Zero();  ///< 3×3, axes of the edge's `from`
  };
  End from;
  End to;
};

/// A measurement as the solver wants it: ν = h − z instead of e, which has the same cost with
/// W = D Ω Dᵀ, D = diag(Rot(θ_z), 1) (docs/conventions.md).
struct Edge {
  int from = 0;
  int to = 0;
  double x = 0.0;  ///< of z
  double y = 0.0;
  double theta = 0.0;
  std::array<double, 6> W{};              ///< xx xy xθ yy yθ θθ, axes of `from`
  const SharedEnds* shared = nullptr;     ///< then W is that of the registration's own errors
  const Eigen::Matrix3d* rows = nullptr;  ///< U of W = Uᵀ U, where W rounds off a weak axis
};

Edge make_edge(const RelativePose& measurement);

/// The rows of edges whose W rounds off what their weakest axis says: one that is 10¹⁴ times
/// weaker than the others has two digits left (own_spread).
class WideRows {
 public:
  /// As make_edge, with its rows where it is such an edge; this must outlive it.
  Edge make_edge(const RelativePose& measurement);

 private:
  std::deque<Eigen::Matrix3d> rows_;
};

/// W times a weight.
void weigh(double weight, Edge& edge);

/// W of an edge, and M of its terms (below), in full.
Eigen::Matrix3d full(const std::array<double, 6>& upper);
/// W⁻¹: the covariance of ν.
Eigen::Matrix3d covariance_of(const Edge& edge);

/// 1 / variance of the heading that an edge measures, its position left free.
double heading_information(const Edge& edge);
/// Whether it measures one: a position fix does not, be it of a point beside the keyframe.
bool measures_heading(const Edge& edge);
inline constexpr double kLeastHeadingShare = 1e-9;

/// A pose with the cosine and sine of its heading. The heading need not be wrapped. Behind the
/// keyframes of a graph stand the errors n of its pictures, where they are unknowns; these have
/// neither cosine nor sine.
struct Node {
  double x = 0.0;
  double y = 0.0;
  double theta = 0.0;
  double c = 1.0;
  double s = 0.0;
};

inline Node make_node(double x, double y, double theta) {
  return {x, y, theta, std::cos(theta), std::sin(theta)};
}
/// The pose moved; the cosine and sine follow a small turn by their series, which is cheaper and
/// rounds each once more.
inline Node moved(const Node& node, double dx, double dy, double turn) {
  constexpr double kSmallTurnRad = 0.03;  // the next terms are below 10⁻¹⁹
  const double x = node.x + dx;
  const double y = node.y + dy;
  const double theta = node.theta + turn;
  if (!(std::abs(turn) < kSmallTurnRad)) return make_node(x, y, theta);
  const double t = turn * turn;
  const double s = turn * (1.0 - t / 6.0 * (1.0 - t / 20.0 * (1.0 - t / 42.0)));
  const double c = -0.5 * t * (1.0 - t / 12.0 * (1.0 - t / 30.0 * (1.0 - t / 56.0)));  // less 1
  return {x, y, theta, node.c + (c * node.c - s * node.s), node.s + (c * node.s + s * node.c)};
}
inline Node make_errors(double n0, double n1, double n2) {
  return {n0, n1, n2, 0.0, 0.0};
}
inline bool is_pose(const Node& node) {
  return node.c != 0.0 || node.s != 0.0;
}
/// How many of the nodes are keyframes; the errors of pictures stand behind them.
std::size_t keyframes_of(std::span<const Node> nodes);

std::vector<Node> nodes_of(std::span<const Pose> poses);
/// With its heading wrapped.
Pose pose_of(const Node& node);

/// ν = h − z, heading wrapped.
Eigen::Vector3d residual_of(const Edge& edge, const Node& i, const Node& k);

/// What one edge adds to ½F and its derivatives. With P = diag(Rot(−θ_i), 1) and
/// T = [1 0 −dy; 0 1 dx; 0 0 1] the Jacobians are ∂h/∂X_k = P and ∂h/∂X_i = −P T, so with
/// M = Pᵀ W P and m = Pᵀ W ν the gradients are m and −Tᵀ m, the Gauss-Newton blocks
/// H_kk = M, H_ik = −Tᵀ M, H_ii = Tᵀ M T.
struct EdgeTerms {
  double cost = 0.0;          ///< νᵀ W ν
  std::array<double, 6> M{};  ///< xx xy xθ yy yθ θθ
  std::array<double, 3> m{};
  double dx = 0.0;  ///< lever of T: p_k − p_i, world axes
  double dy = 0.0;
};

/// Where the lever of T is taken: at the estimate, which gives Gauss-Newton; or at the measured
/// motion, which makes the step independent of the present positions, so that it is exact in them.
enum class Lever { estimated, measured };

/// wrap_angle, without a call for what is wrapped.
inline double wrapped(double angle_rad) {
  return std::abs(angle_rad) < std::numbers::pi ? angle_rad : wrap_angle(angle_rad);
}

inline EdgeTerms linearise_edge(const Edge& edge, const Node& i, const Node& k,
                                Lever lever = Lever::estimated) {
  const auto& W = edge.W;
  EdgeTerms t;
  t.dx = k.x - i.x;
  t.dy = k.y - i.y;
  const double nx = i.c * t.dx + i.s * t.dy - edge.x;
  const double ny = -i.s * t.dx + i.c * t.dy - edge.y;
  const double nt = wrapped(k.theta - i.theta - edge.theta);
  const double wx = W[0] * nx + W[1] * ny + W[2] * nt;
  const double wy = W[1] * nx + W[3] * ny + W[4] * nt;
  const double wt = W[2] * nx + W[4] * ny + W[5] * nt;
  t.cost = nx * wx + ny * wy + nt * wt;
  t.m = {i.c * wx - i.s * wy, i.s * wx + i.c * wy, wt};
  const double cc = i.c * i.c;
  const double ss = i.s * i.s;
  const double cs = i.c * i.s;
  t.M = {cc * W[0] - 2.0 * cs * W[1] + ss * W[3],
         cs * (W[0] - W[3]) + (cc - ss) * W[1],
         i.c * W[2] - i.s * W[4],
         ss * W[0] + 2.0 * cs * W[1] + cc * W[3],
         i.s * W[2] + i.c * W[4],
         W[5]};
  if (lever == Lever::measured) {
    t.dx = i.c * edge.x - i.s * edge.y;
    t.dy = i.s * edge.x + i.c * edge.y;
  }
  return t;
}

/// The same edge with its measurement as the pictures' errors leave it, z − G n.
Edge without_errors(const Edge& edge, std::span<const Node> nodes);

inline EdgeTerms linearise_edge(const Edge& edge, std::span<const Node> nodes,
                                Lever lever = Lever::estimated) {
  const Node& i = nodes[at(edge.from)];
  const Node& k = nodes[at(edge.to)];
  if (edge.shared != nullptr) return linearise_edge(without_errors(edge, nodes), i, k, lever);
  return linearise_edge(edge, i, k, lever);
}

/// What some edges count: s = νᵀ W ν becomes w s, and ρ of that where a loss is on.
struct EdgeLoss {
  RobustLoss loss;
  std::span<const char> is_robust;    ///< by edge; empty: the loss is on none
  std::span<const double> weights{};  ///< by edge; empty: all 1
  std::span<const char> ranks{};      ///< by edge, of W; empty: all 3

  bool leaves_out(std::size_t edge) const { return !weights.empty() && weights[edge] == 0.0; }

  /// m ← w ρ' m and M ← w ρ' M, and with `second_order` M += 2 ρ'' m mᵀ (of w m), which makes the
  /// second derivatives exact where the rest is.
  void apply(std::size_t edge, bool second_order, EdgeTerms& t) const;
};

inline void scale(double factor, EdgeTerms& t) {
  for (double& element : t.M) element *= factor;
  for (double& element : t.m) element *= factor;
}

inline void EdgeLoss::apply(std::size_t edge, bool second_order, EdgeTerms& t) const {
  if (!weights.empty()) {
    t.cost *= weights[edge];
    scale(weights[edge], t);
  }
  if (is_robust.empty() || is_robust[edge] == 0) return;
  const LossValue value = (ranks.empty() ? loss : loss.of_rank(ranks[edge])).at(t.cost);
  const std::array<double, 3> m = t.m;
  t.cost = value.rho;
  scale(value.weight, t);
  if (!second_order) return;
  std::size_t element = 0;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = row; column < 3; ++column) {
      t.M[element++] += 2.0 * value.curvature * m[row] * m[column];
    }
  }
}

/// F = Σ νᵀ W ν + Σ nᵀ n.
double cost_of(std::span<const Edge> edges, std::span<const Node> nodes);

}  // namespace fathom::pose_graph
