#include "fathom/measurements/loop_terms.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "fathom/core/chi_squared.hpp"
#include "fathom/core/median.hpp"
#include "known_ways.hpp"

namespace fathom {
namespace {

double worst_sigma_m(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance.topLeftCorner<2, 2>(),
                                                              Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues().maxCoeff(), 0.0));
}

LoopClosure closure_of(const RelativePose& z, const KnownWay& way) {
  LoopClosure closure{z.from, z.to, way.length_m};
  closure.misfit = z.motion.vector() - way.motion.mean.vector();
  closure.misfit.z() = wrap_angle(closure.misfit.z());
  const Eigen::Matrix3d own = z.alone().covariance();
  closure.covariance = way.motion.covariance + own;
  closure.own_sigma_m = worst_sigma_m(own);
  return closure;
}

// By how much the σ of all loops are to be multiplied.
double scale_of_sigmas(const std::vector<LoopClosure>& closures) {
  if (closures.size() < kLoopsForScale) return 1.0;
  std::vector<double> nis;
  nis.reserve(closures.size());
  for (const LoopClosure& closure : closures) nis.push_back(closure.nis());
  return std::sqrt(upper_median(std::move(nis)) / chi_squared_quantile(0.5, 3.0));
}

}  // namespace

double LoopClosure::misfit_rad() const {
  return std::abs(misfit.z());
}
double LoopClosure::sigma_m() const {
  return worst_sigma_m(covariance);
}
double LoopClosure::sigma_rad() const {
  return std::sqrt(covariance(2, 2));
}
double LoopClosure::nis() const {
  return misfit.dot(covariance.llt().solve(misfit));
}

std::vector<LoopClosure> loop_closures(const MeasurementLog& log) {
  std::vector<LoopClosure> closures;
  KnownWays ways(log.size());
  for (std::size_t k = 1; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    if (!arrival.step.is_hole) ways.add(arrival.step);
    for (const RelativePose& z : arrival.registrations) {
      const std::optional<KnownWay> way = ways.best(z.from, z.to);
      if (way) closures.push_back(closure_of(z, *way));
    }
    for (const RelativePose& z : arrival.registrations) ways.add(z);
  }
  return closures;
}

LoopTerms loop_terms(const MeasurementLog& log) {
  const std::vector<LoopClosure> closures = loop_closures(log);
  LoopTerms terms;
  terms.keyframes = log.size();
  terms.loops = closures.size();
  if (closures.empty()) return terms;
  terms.most_turned = *std::ranges::max_element(closures, {}, &LoopClosure::misfit_rad);
  terms.most_moved = *std::ranges::max_element(closures, {}, &LoopClosure::misfit_m);
  const double scale = scale_of_sigmas(closures);
  for (const LoopClosure& closure : closures) {
    terms.longest_m = std::max(terms.longest_m, closure.way_m);
    const double left_m = 0.5 * closure.way_m * closure.misfit_rad() * closure.misfit_rad();
    // Where all loops agree to the last bit there is no scale, and nothing left either.
    if (left_m == 0.0) continue;
    terms.curvature = std::max(terms.curvature, left_m / (scale * closure.own_sigma_m));
  }
  return terms;
}

}  // namespace fathom
