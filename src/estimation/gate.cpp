#include "fathom/estimation/gate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "fathom/core/chi_squared.hpp"

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
  if (options.probability) threshold_ = chi_squared_quantile(*options.probability, 3.0);
}

bool Gate::passes(double nis) const {
  return !std::isnan(nis) && (!threshold_ || nis <= *threshold_);
}

std::vector<bool> Gate::pass_together(const Eigen::VectorXd& innovation, const Eigen::MatrixXd& S,
                                      std::vector<bool> passed) const {
  if (!joint_probability_) return passed;
  return jointly_compatible(innovation, S, passed, *joint_probability_);
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

double normalised_innovation_squared(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& S) {
  const Eigen::LLT<Eigen::Matrix3d> llt(S);
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  return innovation.dot(llt.solve(innovation));
}

}  // namespace fathom
