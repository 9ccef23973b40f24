#include "estimators/sparse_gauss_newton/leave_one_out.hpp"

#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "estimators/support/sparse/selected_inverse.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom::sparse_gauss_newton {
namespace {

double chi2_of(const Eigen::Vector3d& nu, const Eigen::Matrix3d& S) {
  const Eigen::LLT<Eigen::Matrix3d> llt(0.5 * (S + S.transpose()));
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
  return nu.dot(llt.solve(nu));
}

double without(const Edge& edge, int rank, double w, const sparse::SelectedInverse& inverse,
               const Node& from, const Node& to) {
  PairCovariance pair;
  if (edge.from > 0) pair.A = inverse.block(edge.from - 1);
  if (edge.to > 0) pair.B = inverse.block(edge.to - 1);
  if (edge.from > 0 && edge.to > 0) pair.cross = inverse.block(edge.from - 1, edge.to - 1);
  Eigen::Matrix3d C = between(pose_of(from), pose_of(to), pair).covariance;
  Eigen::Vector3d nu = residual_of(edge, from, to);
  Eigen::Matrix3d R;
  if (rank == 3) {
    R = covariance_of(edge);
  } else {
    const InformationRows measured = rows_of(full(edge.W));
    C = transport(measured.rows, C);
    nu = measured.rows * nu;
    R = measured.variances.asDiagonal();
  }
  if (w == 0.0) return chi2_of(nu, R + C);
  const Eigen::Matrix3d weighted = R / w;
  const Eigen::Matrix3d A_inverse = (weighted - C).inverse();
  // A loop that nothing else checks: A is singular, and there is nothing to say against it.
  if (!A_inverse.allFinite()) return 0.0;
  const double chi2 = chi2_of(weighted * A_inverse * nu, R + C * A_inverse * weighted);
  return std::isfinite(chi2) ? chi2 : 0.0;
}

}  // namespace

std::vector<double> leave_one_out(NormalEquations& equations, const LoopGraph& graph,
                                  std::span<const double> weights, std::span<const Node> nodes) {
  const std::span<const Edge> edges = equations.edges();
  std::vector<double> chi2(edges.size(), 0.0);
  equations.set_loss({RobustLoss(), {}, weights});
  equations.linearise(nodes, Hessian::gauss_newton);
  if (!equations.factorise() || equations.negative_pivots() > 0) return chi2;
  const sparse::SelectedInverse inverse(equations.factor());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (graph.is_loop[e] == 0) continue;
    chi2[e] = graph.as_registration(e, without(edges[e], graph.rank(e), weights[e], inverse,
                                               nodes[at(edges[e].from)], nodes[at(edges[e].to)]));
  }
  return chi2;
}

}  // namespace fathom::sparse_gauss_newton
