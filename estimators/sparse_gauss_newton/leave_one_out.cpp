#include "estimators/sparse_gauss_newton/leave_one_out.hpp"

#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "estimators/support/sparse/selected_inverse.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom::sparse_gauss_newton {
namespace {

Pose pose_of(const Node& node) {
  return {node.x, node.y, node.theta};
}

Eigen::Matrix3d information_of(const Edge& edge) {
  const auto& W = edge.W;
  Eigen::Matrix3d full;
  full << W[0], W[1], W[2], W[1], W[3], W[4], W[2], W[4], W[5];
  return full;
}

double chi2_of(const Eigen::Vector3d& nu, const Eigen::Matrix3d& S) {
  const Eigen::LLT<Eigen::Matrix3d> llt(0.5 * (S + S.transpose()));
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return nu.dot(llt.solve(nu));
}

double without(const Edge& edge, double w, const sparse::SelectedInverse& inverse, const Node& from,
               const Node& to) {
  Eigen::Matrix3d H_from;
  Eigen::Matrix3d H_to;
  const Pose h = between(pose_of(from), pose_of(to), &H_from, &H_to);
  const Eigen::Vector3d nu(h.x - edge.x, h.y - edge.y, wrap_angle(h.theta - edge.theta));
  Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
  if (edge.from > 0) C += transport(H_from, inverse.block(edge.from - 1));
  if (edge.to > 0) C += transport(H_to, inverse.block(edge.to - 1));
  if (edge.from > 0 && edge.to > 0) {
    const Eigen::Matrix3d cross =
        H_from * inverse.block(edge.from - 1, edge.to - 1) * H_to.transpose();
    C += cross + cross.transpose();
  }
  const Eigen::Matrix3d R = symmetric_inverse(information_of(edge));
  if (w == 0.0) return chi2_of(nu, R + C);
  const Eigen::Matrix3d weighted = R / w;
  const Eigen::Matrix3d A_inverse = (weighted - C).inverse();
  // A loop that nothing else checks: A is singular, and there is nothing to say against it.
  if (!A_inverse.allFinite()) return 0.0;
  const double chi2 = chi2_of(weighted * A_inverse * nu, R + C * A_inverse * weighted);
  return std::isfinite(chi2) ? chi2 : 0.0;
}

}  // namespace

std::vector<double> leave_one_out(NormalEquations& equations, std::span<const char> is_loop,
                                  std::span<const double> weights, std::span<const Node> nodes) {
  const std::span<const Edge> edges = equations.edges();
  std::vector<double> chi2(edges.size(), 0.0);
  equations.set_loss({RobustLoss(), {}, weights});
  equations.linearise(nodes, Hessian::gauss_newton);
  if (!equations.factorise() || equations.negative_pivots() > 0) return chi2;
  const sparse::SelectedInverse inverse(equations.factor());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (is_loop[e] == 0) continue;
    chi2[e] =
        without(edges[e], weights[e], inverse, nodes[at(edges[e].from)], nodes[at(edges[e].to)]);
  }
  return chi2;
}

}  // namespace fathom::sparse_gauss_newton
