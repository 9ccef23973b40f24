// Gates and failures where registrations are told what their pictures share.

#include <limits>

#include <gtest/gtest.h>

#include "tests/estimators/shared_filter.hpp"

namespace fathom::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class SharedFilterGates : public SharedFilter {};

INSTANTIATE_TEST_SUITE_P(All, SharedFilterGates, kEachFilter, name_of);

// Keyframes a metre apart, known to a tenth of a millimetre. n of one picture moves x of its
// registrations by 0.1 m a σ, beside 1 mm of their own.
RelativePose registration(std::size_t from, std::size_t to, std::size_t picture, double error_m) {
  SharedErrors shared;
  (from == picture ? shared.from : shared.to).G(0, 0) = 0.1;
  shared.from.sigma = {1.0, 1.0, 1.0};
  shared.to.sigma = {1.0, 1.0, 1.0};
  shared.own = 1e-6 * Eigen::Matrix3d::Identity();
  RelativePose z = RelativePose::from_covariance(
      from, to, {static_cast<double>(to) - static_cast<double>(from) + error_m, 0.0, 0.0},
      shared.total());
  z.shared = std::make_shared<const SharedErrors>(shared);
  return z;
}

void add_step(Estimator& estimator, double heading_variance = 1e-8) {
  const std::size_t k = estimator.size();
  const Eigen::Vector3d variances(1e-8, 1e-8, heading_variance);
  estimator.add_keyframe(
      RelativePose::from_covariance(k - 1, k, {1.0, 0.0, 0.0}, variances.asDiagonal()));
}

std::vector<LoopFate> fates(const UpdateReport& report) {
  std::vector<LoopFate> fates;
  for (const LoopDecision& loop : report.loops) fates.push_back(loop.fate);
  return fates;
}

UpdateReport given(Estimator& estimator, const std::vector<RelativePose>& registrations) {
  return estimator.update({registrations});
}

class Gated {
 public:
  Gated(const std::string& type, const std::string& model)
      : estimator_(builtin_estimators().find(type).create(
            {}, values({{"shared_errors", model},
                        {"gate_probability", "0.99"},
                        {"joint_gate_probability", "0.99"}}))) {}
  Estimator& operator*() { return *estimator_; }
  Estimator* operator->() { return estimator_.get(); }

 private:
  std::unique_ptr<Estimator> estimator_;
};

using enum LoopFate;

// Two σ of what is shared; five.
TEST_P(SharedFilterGates, AGateLetsPassWhatIsSharedAndRefusesAFalseLoop) {
  Gated estimator(type(), model());
  for (int k = 0; k < 4; ++k) add_step(*estimator);
  EXPECT_EQ(fates(given(*estimator, {registration(2, 4, 4, 0.2), registration(1, 4, 1, 0.5)})),
            (std::vector{used, rejected}));
}

// Each may be right, with n of the newest picture at 1.5 σ: not both, if one says +1.5 and the
// other −1.5. As if independent, both.
TEST_P(SharedFilterGates, TheJointGateKnowsThatTheErrorIsOne) {
  for (const bool agree : {true, false}) {
    Gated estimator(type(), model());
    Gated careless(type(), "independent");
    for (Gated* one : {&estimator, &careless}) {
      for (int k = 0; k < 3; ++k) add_step(**one);
    }
    const std::vector<RelativePose> loops{registration(0, 3, 3, 0.15),
                                          registration(1, 3, 3, agree ? 0.15 : -0.15),
                                          registration(2, 3, 3, 0.15)};
    EXPECT_EQ(fates(given(*estimator, loops)), (std::vector{used, agree ? used : rejected, used}));
    EXPECT_EQ(fates(given(*careless, loops)), (std::vector{used, used, used}));
  }
}

// n of picture 3 is known by its registrations. What it is not is refused by a filter that has
// estimated it; one that only considers it says that it may be.
TEST_P(SharedFilterGates, AGateTestsWhatIsLeft) {
  Gated estimator(type(), model());
  for (int k = 0; k < 3; ++k) add_step(*estimator);
  given(*estimator, {registration(1, 3, 3, 0.15), registration(2, 3, 3, 0.15)});
  const auto& errors = picture_errors_of(*estimator);
  EXPECT_NEAR(errors.estimate(3).x(), model() == "states" ? 1.5 : 0.0, 0.01);
  add_step(*estimator);
  EXPECT_EQ(fates(given(*estimator, {registration(3, 4, 3, 0.15)})), (std::vector{used}));
  add_step(*estimator);
  EXPECT_EQ(fates(given(*estimator, {registration(3, 5, 3, -0.15)})),
            (std::vector{model() == "states" ? rejected : used}));
}

// Failure leaves n̂ as it was, too.
TEST_P(SharedFilterGates, AFailedUpdateChangesNothing) {
  const auto estimator = builtin_estimators().find(type()).create({}, options());
  for (int k = 0; k < 12; ++k) {
    add_step(*estimator, 0.09);
    if (k == 5) given(*estimator, {registration(4, 6, 6, 0.02), registration(5, 6, 6, 0.02)});
  }
  // So that the heading of 6 has a part in the motion from there.
  given(*estimator, {registration(0, 12, 0, 0.0)});
  const auto& errors = picture_errors_of(*estimator);
  EXPECT_NEAR(errors.estimate(6).x(), model() == "states" ? 0.2 : 0.0, 1e-3);
  // Not a number; own errors that rounding hides; half a turn that no linearisation reaches.
  const RelativePose nan = registration(6, 12, 6, kNaN);
  RelativePose hidden = registration(6, 12, 6, 0.0);
  RelativePose turned = registration(6, 12, 6, 0.02);
  SharedErrors shared = *hidden.shared;
  shared.own *= 1e-24;
  hidden.shared = std::make_shared<const SharedErrors>(shared);
  shared.own.diagonal() << 1e-6, 1e-6, 1e-2;
  turned.shared = std::make_shared<const SharedErrors>(shared);
  turned.motion.theta = 3.0;
  const std::vector<Pose> poses = poses_of(*estimator);
  const Eigen::MatrixXd P = whole_covariance(*estimator);
  const Eigen::Vector3d n = errors.estimate(6);
  for (const auto& [z, outcome] :
       {std::pair{nan, Outcome::numerical_failure}, std::pair{hidden, Outcome::numerical_failure},
        std::pair{turned, Outcome::diverged}}) {
    // A twist meets it; iterations come near.
    const bool is_met = type() == "invariant_ekf" || type() == "trajectory_iekf";
    if (outcome == Outcome::diverged && is_met) continue;
    const UpdateReport report = given(*estimator, {z});
    EXPECT_EQ(report.outcome, outcome);
    EXPECT_EQ(fates(report), (std::vector{lost}));
    EXPECT_EQ(largest_distance(poses_of(*estimator), poses), 0.0);
    EXPECT_EQ((whole_covariance(*estimator) - P).norm(), 0.0);
    EXPECT_EQ(errors.estimate(6), n);
  }
}

}  // namespace
}  // namespace fathom::test
