#pragma once

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fathom/estimation/registry.hpp"

namespace fathom::test {

/// What a ScriptedEstimator is to do, and what it was asked to.
struct Script {
  std::vector<UpdateReport> updates;  ///< one per update, its decisions made from `rejected`
  UpdateReport finish;
  std::set<std::pair<std::size_t, std::size_t>> rejected;  ///< (from, to)
  std::function<double(double)> loss = [](double chi2) { return chi2; };
  std::optional<std::size_t> without_covariance;
  std::optional<std::size_t> nan_pose;
  std::function<void()> in_every_call = [] {};
  std::function<void(UpdateReport&)> spoil_report = [](UpdateReport&) {};
  std::size_t size_error = 0;  ///< what size() says beyond the truth
  std::vector<double> loop_weights;
  std::map<std::size_t, Eigen::Matrix3d> covariances;  ///< of these keyframes, in place of k·I
  /// So many calls of joint_covariance have an answer, the identity; each is among `calls`.
  std::size_t joint_covariances = 0;
  double joint_covariance_factor = 1.0;  ///< on that identity

  /// What moved_since names.
  std::optional<std::vector<std::size_t>> moved;

  std::vector<std::string> calls;
};

/// Dead reckoning that does what it is told: the harness is to be tested, not an estimator.
class ScriptedEstimator : public Estimator {
 public:
  ScriptedEstimator(const EstimatorSetup& setup, Script& script)
      : script_(script), poses_{setup.start.pose} {
    note(setup.mode == SolveMode::batch ? "create batch" : "create");
    script_.in_every_call();
  }

  std::size_t size() const override { return poses_.size() + script_.size_error; }
  Pose pose(std::size_t k) const override {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    return script_.nan_pose == k ? Pose{kNaN, 0, 0} : poses_[k];
  }

  MovedPoses moved_since(std::uint64_t /*revision*/) const override { return {1, script_.moved}; }

  void add_keyframe(const RelativePose& step) override {
    note("add " + std::to_string(step.to));
    script_.in_every_call();
    poses_.push_back(compose(poses_.back(), step.motion));
  }

  UpdateReport update(const Measurements& measurements) override {
    script_.in_every_call();
    UpdateReport report;
    if (updates_ < script_.updates.size()) report = script_.updates[updates_++];
    std::string call = "close";
    for (const RelativePose& z : measurements.registrations) {
      call += " " + std::to_string(z.from) + "-" + std::to_string(z.to);
      const bool rejected = script_.rejected.contains({z.from, z.to});
      report.loops.push_back({z.from, z.to, rejected ? LoopFate::rejected : LoopFate::used, 2.5});
    }
    for (const AbsolutePose& z : measurements.absolute) {
      call += " at " + std::to_string(z.keyframe);
      report.absolute.push_back({z.keyframe, LoopFate::used, 1.5});
    }
    note(call);
    script_.spoil_report(report);
    return report;
  }

  UpdateReport finish(std::span<const Pose> start) override {
    note("finish from " + std::to_string(start.size()));
    script_.in_every_call();
    return script_.finish;
  }

  std::optional<Eigen::Matrix3d> covariance(std::size_t k) const override {
    if (script_.without_covariance == k) return std::nullopt;
    if (const auto given = script_.covariances.find(k); given != script_.covariances.end()) {
      return given->second;
    }
    return Eigen::Matrix3d(Eigen::Matrix3d::Identity() * static_cast<double>(k));
  }

  std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> keyframes) const override {
    std::string call = "covariance";
    for (const std::size_t k : keyframes) call += " " + std::to_string(k);
    note(call);
    if (asked_++ >= script_.joint_covariances) return std::nullopt;
    const auto size = static_cast<Eigen::Index>(3 * keyframes.size());
    return Eigen::MatrixXd(script_.joint_covariance_factor * Eigen::MatrixXd::Identity(size, size));
  }

  double loss(double chi2, int /*rank*/) const override { return script_.loss(chi2); }
  std::vector<double> loop_weights() const override { return script_.loop_weights; }

 private:
  // Trials of a study share a script.
  void note(const std::string& call) const {
    const std::scoped_lock lock(noting_);
    script_.calls.push_back(call);
  }

  inline static std::mutex noting_;
  Script& script_;
  std::vector<Pose> poses_;
  std::size_t updates_ = 0;
  mutable std::size_t asked_ = 0;
};

/// An entry that makes estimators of this script, which must outlive it.
inline EstimatorEntry scripted(Script& script) {
  EstimatorEntry entry;
  entry.name = "scripted";
  entry.can_batch = true;
  entry.create = [&script](const EstimatorSetup& setup, const EstimatorValues&) {
    return std::make_unique<ScriptedEstimator>(setup, script);
  };
  return entry;
}

}  // namespace fathom::test
