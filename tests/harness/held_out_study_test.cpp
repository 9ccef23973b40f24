// Held-out loops of studies: over many trials of the model itself, and what is never held out.

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/harness/study_run.hpp"
#include "harness/held_out.hpp"
#include "src/harness/held_out_run.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::Metrics;
using test::metrics_of;
using ::testing::HasSubstr;

constexpr const char* kDrawnLog = R"(
dataset:
  type: simulated_log
  mission: {type: sweep, legs: 12, leg_length_m: 8, leg_spacing_m: 1.0}
  separation_frames: 2
  odometry: {sigma_x_m: 0.002, sigma_y_m: 0.002, sigma_theta_rad: 0.001}
  loops: {max_distance_m: 1.4, probability: 0.7, sigma_x_m: 0.004, sigma_y_m: 0.004,
          sigma_theta_rad: 0.002}
estimators: [{type: sparse_gauss_newton}, {type: ekf}]
)";

std::map<std::string, Metrics> study_metrics(const std::string& text, bool of_held_out,
                                             int jobs = 1) {
  const Study study = configure_study(test::settings_of(kDrawnLog + text), builtin_estimators());
  const test::TemporaryFolder folder;
  ResultStore store = ResultStore::write(folder.path(), study.description, "{}");
  StudyRunOptions options;
  options.jobs = jobs;
  EXPECT_TRUE(run_study(study, builtin_estimators(), store, options).is_finished);
  std::map<std::string, Metrics> metrics;
  for (const RunRecord& run : store.runs()) {
    const std::string name = std::to_string(run.key.trial) + " " + run.key.estimator;
    metrics[name + " " + run.log_hash] = metrics_of(run.metrics, of_held_out);
  }
  return metrics;
}

TEST(HeldOutStudy, ChangesNoOtherMetric) {
  const auto with = study_metrics("trials: 3\n", false);
  EXPECT_EQ(with.size(), 9u);
  EXPECT_EQ(with, study_metrics("trials: 3\nevaluation: {held_out_loops: 0}\n", false));
}

TEST(HeldOutStudy, DoesNotDependOnTheNumberOfJobs) {
  const auto one = study_metrics("trials: 4\n", true);
  EXPECT_EQ(one, study_metrics("trials: 4\n", true, 2));
  for (const auto& [run, metrics] : one) EXPECT_EQ(metrics.size(), 6u) << run;
  for (const auto& [run, metrics] : study_metrics("evaluation: {held_out_loops: 0}\n", true)) {
    EXPECT_TRUE(metrics.empty()) << run;
  }
}

// A trial of the study's own, with its held-out loops.
Recording held_out_trial(const Configuration& configuration, std::uint64_t trial) {
  const TrialNoise noise{5, trial};
  Recording recording =
      Recorder(configuration)
          .record(configuration, configuration.reference, builtin_estimators(), noise);
  hold_out(recording, configuration.study.evaluation, noise);
  return recording;
}

TEST(HeldOutStudy, HoldsOutNoFalseLoop) {
  const Configuration configuration =
      test::configured(std::string(kDrawnLog) + "association.false_loops: {share: 0.4}\n" +
                           "evaluation: {held_out_loops: 0.5}\n",
                       test::kComparison);
  const Recording recording = held_out_trial(configuration, 0);
  std::size_t false_loops = 0;
  std::size_t held_out = 0;
  for (std::size_t place = 0; place < recording.is_held_out.size(); ++place) {
    EXPECT_FALSE(recording.is_false_loop[place] && recording.is_held_out[place]);
    false_loops += recording.is_false_loop[place] ? 1 : 0;
    held_out += recording.is_held_out[place] ? 1 : 0;
  }
  EXPECT_GT(false_loops, 50u);
  EXPECT_GT(held_out, 50u);
}

// Of each estimator, by trial.
std::map<std::string, std::vector<double>> drawn_nis(const std::string& text, std::uint64_t trials,
                                                     const std::vector<std::string>& estimators) {
  const Configuration configuration = test::configured(kDrawnLog + text, test::kComparison);
  std::map<std::string, std::vector<double>> nis;
  for (std::uint64_t trial = 0; trial < trials; ++trial) {
    const Recording recording = held_out_trial(configuration, trial);
    for (const std::string& name : estimators) {
      const Result result = evaluate(recording, {name, name, {}}, builtin_estimators(), {}, {});
      nis[name].push_back(result.metric("held_out_nis").value());
    }
  }
  return nis;
}

// Trials are independent, the loops of one are not.
TEST(HeldOutStudy, OfTheModelItselfTheNisIsThree) {
  const auto nis = drawn_nis("evaluation: {held_out_loops: 0.3}\n", 150,
                             {"sparse_gauss_newton", "incremental_smoother", "ekf"});
  for (const auto& [name, of_trials] : nis) {
    const Eigen::Map<const Eigen::ArrayXd> values(of_trials.data(),
                                                  static_cast<Eigen::Index>(of_trials.size()));
    const auto n = static_cast<double>(values.size());
    const double variance = (values - values.mean()).square().sum() / (n - 1.0);
    EXPECT_LT(std::sqrt(variance / n), 0.05) << name;
    EXPECT_NEAR(values.mean(), 3.0, 3.0 * std::sqrt(variance / n)) << name;
  }
}

// Loops off by twice what they are told of.
TEST(HeldOutStudy, TheNisOfOverconfidentLoopsIsAboveThree) {
  const auto nis = drawn_nis("dataset.loops: {tail_share: 1, tail_factor: 2}\n", 10, {"ekf"});
  double sum = 0.0;
  for (const double one : nis.at("ekf")) sum += one;
  EXPECT_GT(sum / 10.0, 6.0);
}

TEST(HeldOutStudy, KeysOfAStudy) {
  const auto refused = [](const std::string& text) {
    return test::refusal(kDrawnLog + text, test::kComparison);
  };
  EXPECT_THAT(refused("evaluation: {held_out_loops: 0.6}\n"), HasSubstr("<= 0.5"));
  EXPECT_THAT(
      refused("evaluation: {held_out_loops: 0, held_out_pairs: 5}\n"),
      HasSubstr("evaluation.held_out_pairs: evaluation.held_out_loops 0 has no use for it"));
}

}  // namespace
}  // namespace fathom
