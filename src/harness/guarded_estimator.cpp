#include "fathom/harness/guarded_estimator.hpp"

#include <exception>
#include <fmt/format.h>
#include <limits>
#include <new>

#include "estimator_contract.hpp"
#include "fathom/core/environment_error.hpp"
#include "fathom/core/program.hpp"

namespace fathom {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

UpdateReport failed(const Measurements& measurements) {
  UpdateReport report;
  report.outcome = Outcome::numerical_failure;
  for (const RelativePose& z : measurements.registrations) {
    report.loops.push_back({z.from, z.to, LoopFate::lost, std::nullopt});
  }
  for (const AbsolutePose& z : measurements.absolute) {
    report.absolute.push_back({z.keyframe, LoopFate::lost, std::nullopt});
  }
  return report;
}

}  // namespace

GuardedEstimator::GuardedEstimator(const EstimatorEntry& entry, const EstimatorSetup& setup,
                                   const EstimatorValues& values) {
  std::exception_ptr bad_input;
  guarded("create", [&] {
    try {
      estimator_ = entry.create(setup, values);
    } catch (const InputError&) {
      bad_input = std::current_exception();
    }
  });
  if (bad_input) std::rethrow_exception(bad_input);
  check_size("create");
}

// Runs a call unless there was a fault already; what it throws is one. Texts are made only when
// needed, as the clock runs meanwhile.
template <class Call>
void GuardedEstimator::guarded(const char* what, Call call) const {
  if (!fault_.empty()) return;
  const auto at = [&] { return fmt::format("{} at keyframe {}", what, size_ - 1); };
  try {
    call();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const EnvironmentError&) {
    throw;
  } catch (const ContractViolation& violation) {
    fault_ = at() + ": " + violation.what();
  } catch (const ProgramFailure& failure) {
    fault_ = at() + ": " + failure.what();
    fault_outcome_ = Outcome::crashed;
  } catch (const std::exception& error) {
    fault_ = at() + " threw an exception: " + error.what();
  } catch (...) {
    fault_ = at() + " threw what is no std::exception";
  }
}

void GuardedEstimator::check_size(const char* call) const {
  guarded(call, [&] {
    const std::size_t size = estimator_->size();
    if (size != size_) {
      throw ContractViolation(fmt::format("size() is {}, expected {}", size, size_));
    }
  });
}

Pose GuardedEstimator::pose(std::size_t k) const {
  Pose pose{kNaN, kNaN, kNaN};
  guarded("pose", [&] {
    pose = estimator_->pose(k);
    if (!is_finite(pose)) throw ContractViolation("pose " + std::to_string(k) + " is not finite");
  });
  return pose;
}

// After a fault any pose is another: NaN.
MovedPoses GuardedEstimator::moved_since(std::uint64_t revision) const {
  MovedPoses moved;
  guarded("moved_since", [&] {
    moved = estimator_->moved_since(revision);
    if (!moved.keyframes) return;
    for (const std::size_t k : *moved.keyframes) {
      if (k >= size_) throw ContractViolation("names keyframe " + std::to_string(k));
    }
  });
  if (!fault_.empty()) moved.keyframes.reset();
  return moved;
}

std::optional<std::vector<UncertainPose>> GuardedEstimator::motions_to_newest() const {
  std::optional<std::vector<UncertainPose>> motions;
  guarded("motions_to_newest", [&] {
    motions = estimator_->motions_to_newest();
    if (motions) require_count(motions->size(), size_ - 1, "motions");
  });
  if (!fault_.empty()) motions.reset();
  return motions;
}

void GuardedEstimator::add_keyframe(const RelativePose& step) {
  ++size_;
  guarded("add_keyframe", [&] { estimator_->add_keyframe(step); });
  check_size("add_keyframe");
}

UpdateReport GuardedEstimator::update(const Measurements& measurements) {
  registrations_ += measurements.registrations.size();
  absolute_ += measurements.absolute.size();
  UpdateReport report;
  guarded("update", [&] {
    report = estimator_->update(measurements);
    require_outcome(report.outcome);
    require_decisions(report, measurements);
  });
  check_size("update");
  if (!fault_.empty()) report = failed(measurements);
  return report;
}

UpdateReport GuardedEstimator::finish(std::span<const Pose> start) {
  UpdateReport report;
  guarded("finish", [&] {
    report = estimator_->finish(start);
    require_outcome(report.outcome);
    require_count(report.loops.size(), 0, "decisions on registrations");
  });
  check_size("finish");
  if (!fault_.empty()) report = failed({});
  return report;
}

std::optional<Eigen::Matrix3d> GuardedEstimator::covariance(std::size_t k) const {
  std::optional<Eigen::Matrix3d> covariance;
  guarded("covariance", [&] {
    covariance = estimator_->covariance(k);
    if (!covariance) return;
    const char* const flaw = flaw_of(*covariance);
    if (flaw != nullptr) throw ContractViolation(fmt::format("that of keyframe {} {}", k, flaw));
  });
  if (!fault_.empty()) covariance.reset();
  return covariance;
}

std::optional<Eigen::Matrix3d> GuardedEstimator::newest_covariance() const {
  std::optional<Eigen::Matrix3d> covariance;
  guarded("newest_covariance", [&] {
    covariance = estimator_->newest_covariance();
    if (!covariance) return;
    const char* const flaw = flaw_of(*covariance);
    if (flaw != nullptr) throw ContractViolation(fmt::format("it {}", flaw));
  });
  if (!fault_.empty()) covariance.reset();
  return covariance;
}

std::optional<Eigen::MatrixXd> GuardedEstimator::joint_covariance(
    std::span<const std::size_t> keyframes) const {
  std::optional<Eigen::MatrixXd> covariance;
  guarded("joint_covariance", [&] {
    covariance = estimator_->joint_covariance(keyframes);
    if (!covariance) return;
    require_count(static_cast<std::size_t>(covariance->rows()), 3 * keyframes.size(), "rows");
    require_count(static_cast<std::size_t>(covariance->cols()), 3 * keyframes.size(), "columns");
    const char* const flaw = flaw_of(*covariance);
    if (flaw != nullptr) throw ContractViolation(fmt::format("it {}", flaw));
  });
  if (!fault_.empty()) covariance.reset();
  return covariance;
}

bool GuardedEstimator::estimates_shared_errors() const {
  bool estimates = false;
  guarded("estimates_shared_errors", [&] { estimates = estimator_->estimates_shared_errors(); });
  return estimates;
}

double GuardedEstimator::loss(double chi2, int rank) const {
  double loss = kNaN;
  guarded("loss", [&] { loss = estimator_->loss(chi2, rank); });
  return loss;
}

template <class Ask>
std::vector<double> GuardedEstimator::weights(const char* what, std::size_t count, Ask ask) const {
  std::vector<double> weights;
  guarded(what, [&] {
    weights = ask();
    if (!weights.empty()) require_count(weights.size(), count, "weights");
    require_weights(weights);
  });
  if (!fault_.empty()) weights.clear();
  return weights;
}

std::vector<double> GuardedEstimator::loop_weights() const {
  return weights("loop_weights", registrations_, [&] { return estimator_->loop_weights(); });
}

std::vector<double> GuardedEstimator::absolute_weights() const {
  return weights("absolute_weights", absolute_, [&] { return estimator_->absolute_weights(); });
}

}  // namespace fathom
