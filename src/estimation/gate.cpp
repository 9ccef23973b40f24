#include "fathom/estimation/gate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "fathom/core/chi_squared.hpp"
#include "fathom/estimation/loop_rows.hpp"
#include "fathom/estimation/precision.hpp"

namespace fathom {

void GateOptions::describe(OptionTable& table) {
  table.real_or_off("gate_probability", probability, Range{1e-6, 1.0 - 1e-12}, "",
                    "chi-squared gate: share of right registrations that passes");
}

void GateOptions::describe_joint(OptionTable& table) {
  table.real_or_off("joint_gate_probability", joint_probability, Range{1e-6, 1.0 - 1e-12}, "",
                    "joint compatibility of a keyframe's registrations: share of right sets that "
                    "passes");
}

Gate::Gate(const GateOptions& options) : joint_probability_(options.joint_probability) {
  if (!options.probability) return;
  thresholds_.emplace();
  for (int rank = 1; rank <= 3; ++rank) {
    (*thresholds_)[static_cast<std::size_t>(rank)] =
        chi_squared_quantile(*options.probability, rank);
  }
}

bool Gate::passes(double nis, int rank) const {
  return !std::isnan(nis) &&
         (!thresholds_ || nis <= (*thresholds_)[static_cast<std::size_t>(rank)]);
}

std::vector<bool> Gate::pass_together(const Eigen::VectorXd& innovation, const Eigen::MatrixXd& S,
                                      std::vector<bool> passed, std::span<const int> ranks) const {
  if (!joint_probability_) return passed;
  return jointly_compatible(innovation, S, passed, *joint_probability_, ranks);
}

bool has_finite_nis(const UpdateReport& report) {
  return std::all_of(report.loops.begin(), report.loops.end(), [](const LoopDecision& loop) {
    return !loop.nis || std::isfinite(*loop.nis);
  });
}

LoopFate fate_of(bool passes) {
  return passes ? LoopFate::used : LoopFate::rejected;
}

void lose_all(UpdateReport& report, Outcome outcome) {
  report.outcome = outcome;
  for (LoopDecision& loop : report.loops) {
    // No gate has judged what is no number.
    const bool judged = !loop.nis || std::isfinite(*loop.nis);
    if (loop.fate == LoopFate::used || !judged) loop.fate = LoopFate::lost;
  }
}

bool judge(const Gate& gate, const TrajectoryView& estimate,
           std::span<const RelativePose> registrations, const PredictedCovariances& covariances,
           UpdateReport& report) {
  std::vector<RelativePose> forward;
  bool finite = true;
  for (const RelativePose& z : registrations) {
    report.loops.push_back({z.from, z.to, LoopFate::used, std::nullopt});
    finite = finite && is_finite(z.motion) && z.information.allFinite();
    forward.push_back(z.forward());
  }
  if (!finite || !are_resolved(estimate, registrations)) return false;
  if (!gate.is_on()) return true;
  const auto predicted = covariances(forward);
  if (!predicted) return false;
  for (std::size_t j = 0; j < forward.size(); ++j) {
    const Pose h = between(estimate.pose(forward[j].from), estimate.pose(forward[j].to));
    Eigen::Vector3d nu = forward[j].motion.vector() - h.vector();
    nu.z() = wrap_angle(nu.z());
    const LoopRows rows = loop_rows(forward[j]);
    report.loops[j].nis = rows.is_whole()
                              ? normalised_innovation_squared(nu, (*predicted)[j] + rows.R)
                              : normalised_innovation_squared(
                                    rows.C * nu, transport(rows.C, (*predicted)[j]) + rows.R);
    report.loops[j].fate = fate_of(gate.passes(*report.loops[j].nis, rows.rank));
  }
  return true;
}

UpdateReport judged_update(
    const Gate& gate, const TrajectoryView& estimate, std::span<const RelativePose> registrations,
    const PredictedCovariances& covariances,
    const std::function<UpdateReport(std::span<const RelativePose> used)>& minimise,
    std::span<const RelativePose> as_judged) {
  UpdateReport report;
  if (registrations.empty()) return report;
  if (as_judged.empty()) as_judged = registrations;
  if (!judge(gate, estimate, as_judged, covariances, report)) {
    lose_all(report, Outcome::numerical_failure);
    return report;
  }
  std::vector<RelativePose> used;
  for (std::size_t j = 0; j < registrations.size(); ++j) {
    if (report.loops[j].fate == LoopFate::used) used.push_back(registrations[j]);
  }
  if (used.empty()) return report;
  UpdateReport solved = minimise(used);
  solved.loops = std::move(report.loops);
  if (!is_done(solved.outcome)) lose_all(solved, solved.outcome);
  return solved;
}

double normalised_innovation_squared(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& S) {
  const Eigen::LLT<Eigen::Matrix3d> llt(S);
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  return innovation.dot(llt.solve(innovation));
}

}  // namespace fathom
