#include "estimator_contract.hpp"

#include <cmath>
#include <fmt/format.h>
#include <span>

#include "fathom/geometry/symmetry.hpp"

namespace fathom {
namespace {

bool is_of(const LoopDecision& loop, const RelativePose& z) {
  return (loop.from == z.from && loop.to == z.to) || (loop.from == z.to && loop.to == z.from);
}

// What rounding may leave beyond the ends of a figure of the order of 1: of single precision, or of
// a difference of two large ones.
constexpr double kRounded = 1e-6;

template <class Decisions>
void require_nis(const Decisions& decisions, const char* on_what) {
  for (std::size_t j = 0; j < decisions.size(); ++j) {
    if (!(decisions[j].nis && *decisions[j].nis < -kRounded)) continue;
    throw ContractViolation(fmt::format("decision {} on {} has the NIS {:.3g}, expected 0 or more",
                                        j, on_what, *decisions[j].nis));
  }
}

}  // namespace

void require_count(std::size_t count, std::size_t expected, const char* of_what) {
  if (count == expected) return;
  throw ContractViolation(fmt::format("has {} {}, expected {}", count, of_what, expected));
}

void require_outcome(Outcome outcome) {
  if (outcome >= Outcome::converged && outcome <= Outcome::numerical_failure) return;
  throw ContractViolation("its outcome is none of an update");
}

void require_decisions(const UpdateReport& report, const Measurements& measurements) {
  const std::span<const RelativePose> registrations = measurements.registrations;
  const std::span<const AbsolutePose> absolute = measurements.absolute;
  require_count(report.loops.size(), registrations.size(), "decisions on registrations");
  for (std::size_t j = 0; j < registrations.size(); ++j) {
    if (is_of(report.loops[j], registrations[j])) continue;
    throw ContractViolation(
        fmt::format("decision {0} is on other keyframes than registration {0}", j));
  }
  require_count(report.absolute.size(), absolute.size(), "decisions on absolute measurements");
  for (std::size_t j = 0; j < absolute.size(); ++j) {
    if (report.absolute[j].keyframe == absolute[j].keyframe) continue;
    throw ContractViolation(
        fmt::format("decision {0} is on another keyframe than absolute measurement {0}", j));
  }
  require_nis(report.loops, "registrations");
  require_nis(report.absolute, "absolute measurements");
}

void require_weights(const std::vector<double>& weights) {
  for (const double weight : weights) {
    if (!std::isfinite(weight)) throw ContractViolation("a weight is not finite");
    if (weight >= -kRounded && weight <= 1.0 + kRounded) continue;
    throw ContractViolation(fmt::format("a weight is {:.3g}, expected 0 to 1", weight));
  }
}

const char* flaw_of(const Eigen::Ref<const Eigen::MatrixXd>& covariance) {
  if (!covariance.allFinite()) return "is not finite";
  // P - K H P of many updates gathers rounding; a triangle, or axes in another order, is far more.
  constexpr double kGathered = 1e-4;
  if (!is_symmetric(covariance, kGathered)) return "is not symmetric";
  // What rounding may leave of a variance of zero, in m² and rad².
  constexpr double kFloor = 1e-15;
  const double least = -(kSymmetryRounding * covariance.norm() + kFloor);
  if ((covariance.diagonal().array() < least).any()) return "has a negative variance";
  return nullptr;
}

}  // namespace fathom
