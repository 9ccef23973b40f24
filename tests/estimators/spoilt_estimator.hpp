#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "fathom/estimation/registry.hpp"

namespace fathom::test {

/// What is changed on the way to an estimator and back; what is empty changes nothing.
struct Spoils {
  std::function<void(EstimatorSetup&, EstimatorValues&)> setup{};
  std::function<void(RelativePose&)> step{};
  std::function<void(std::vector<RelativePose>&)> registrations{};
  std::function<void(std::vector<AbsolutePose>&)> absolute{};
  std::function<void(UpdateReport&)> report{};
  std::function<void(std::size_t&)> size{};
  std::function<void(Pose&)> pose{};
  std::function<void(std::optional<Eigen::Matrix3d>&)> covariance{};
  std::function<void(std::optional<Eigen::Matrix3d>&)> newest_covariance{};
  std::function<void(std::optional<Eigen::MatrixXd>&)> joint{};
  std::function<void(std::vector<UncertainPose>&)> motions{};
  /// With all registrations so far.
  std::function<void(std::vector<double>&, const std::vector<RelativePose>&)> weights{};
};

/// Passes every call on to another estimator, and spoils it.
class SpoiltEstimator : public Estimator {
 public:
  SpoiltEstimator(std::unique_ptr<Estimator> good, const Spoils& spoils)
      : good_(std::move(good)), spoils_(spoils) {}

  std::size_t size() const override { return spoilt(spoils_.size, good_->size()); }
  Pose pose(std::size_t k) const override { return spoilt(spoils_.pose, good_->pose(k)); }
  bool estimates_shared_errors() const override { return good_->estimates_shared_errors(); }
  MovedPoses moved_since(std::uint64_t revision) const override {
    return good_->moved_since(revision);
  }

  void add_keyframe(const RelativePose& step) override {
    good_->add_keyframe(spoilt(spoils_.step, step));
  }

  UpdateReport update(const Measurements& given) override {
    const auto& [registrations, absolute] = given;
    registrations_.insert(registrations_.end(), registrations.begin(), registrations.end());
    const auto passed_on =
        spoilt(spoils_.registrations,
               std::vector<RelativePose>(registrations.begin(), registrations.end()));
    const auto passed_on_absolute =
        spoilt(spoils_.absolute, std::vector<AbsolutePose>(absolute.begin(), absolute.end()));
    UpdateReport report = good_->update({passed_on, passed_on_absolute});
    // What was dropped on the way is said to be used.
    for (std::size_t j = report.loops.size(); j < registrations.size(); ++j) {
      report.loops.push_back({registrations[j].from, registrations[j].to, LoopFate::used, 1.0});
    }
    for (std::size_t j = report.absolute.size(); j < absolute.size(); ++j) {
      report.absolute.push_back({absolute[j].keyframe, LoopFate::used, 1.0});
    }
    return spoilt(spoils_.report, report);
  }

  UpdateReport finish(std::span<const Pose> start) override { return good_->finish(start); }

  std::optional<Eigen::Matrix3d> covariance(std::size_t k) const override {
    return spoilt(spoils_.covariance, good_->covariance(k));
  }
  std::optional<Eigen::Matrix3d> newest_covariance() const override {
    return spoilt(spoils_.newest_covariance, good_->newest_covariance());
  }
  std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> keyframes) const override {
    return spoilt(spoils_.joint, good_->joint_covariance(keyframes));
  }
  std::optional<std::vector<UncertainPose>> motions_to_newest() const override {
    return spoilt(spoils_.motions, *good_->motions_to_newest());
  }
  double loss(double chi2, int rank) const override { return good_->loss(chi2, rank); }
  std::vector<double> absolute_weights() const override { return good_->absolute_weights(); }
  std::vector<double> loop_weights() const override {
    std::vector<double> weights = good_->loop_weights();
    if (spoils_.weights) spoils_.weights(weights, registrations_);
    return weights;
  }

 private:
  template <class Hook, class Value>
  static Value spoilt(const Hook& hook, Value value) {
    if (hook) hook(value);
    return value;
  }

  std::unique_ptr<Estimator> good_;
  Spoils spoils_;
  std::vector<RelativePose> registrations_;  ///< all that were given
};

inline EstimatorEntry spoilt(const EstimatorEntry& good, const Spoils& spoils) {
  EstimatorEntry entry = good;
  entry.create = [good, spoils](const EstimatorSetup& setup, const EstimatorValues& values) {
    EstimatorSetup changed_setup = setup;
    EstimatorValues changed_values = values;
    if (spoils.setup) spoils.setup(changed_setup, changed_values);
    return std::make_unique<SpoiltEstimator>(good.create(changed_setup, changed_values), spoils);
  };
  return entry;
}

}  // namespace fathom::test
