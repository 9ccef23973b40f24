// What selects the loop candidates of a comparison: ground truth, an estimator that is no
// contender, or a contender that every table names.

#include <filesystem>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"
#include "fathom/configuration/study.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/harness/ground_truth.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/harness/survey.hpp"
#include "harness/scripted_estimator.hpp"
#include "harness/small_config.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using test::kSmallSurvey;
using test::refusal;
using test::settings_of;
using ::testing::HasSubstr;
using Kind = CandidateReference::Kind;

constexpr const char* kList = "estimators: [{type: ekf}, {type: trajectory_iekf, name: many}]\n";

Study study_of(const std::string& text) {
  return configure_study(settings_of(text), builtin_estimators());
}

Study settled(const std::string& text) {
  Study study = study_of(text);
  settle_reference(study, builtin_estimators());
  return study;
}

std::string value_of(const Study& study, const std::string& key) {
  for (const auto& [name, value] : study.description.configuration) {
    if (name == key) return value;
  }
  return "(absent)";
}

// The small survey on disk, all its frames with true poses, or none.
class Folder {
 public:
  explicit Folder(bool with_truth) {
    write_image_folder(Survey(test::configured(kSmallSurvey)).frames(), folder_.path());
    if (!with_truth) {
      std::filesystem::remove_all(folder_ / "mav0/state_groundtruth_estimate0");
    }
  }
  std::string text() const {
    return "dataset: {type: image_folder, path: " + folder_.path().string() + "}\n" +
           "front_end: {keyframes: {separation_frames: 3}}\n" + kList;
  }

 private:
  test::TemporaryFolder folder_;
};

TEST(Reference, IsGroundTruthWhereThereIsOne) {
  const Study study = settled(std::string(kSmallSurvey) + kList);
  EXPECT_EQ(study.cells[0].reference.kind, Kind::ground_truth);
  EXPECT_EQ(value_of(study, "association.reference"), "ground_truth");
  EXPECT_EQ(study.description.selected_by(0), "ground truth");
  const Folder folder(true);
  EXPECT_EQ(settled(folder.text()).description.selected_by(0), "ground truth");
}

TEST(Reference, IsNoContenderWhereThereIsNone) {
  const Folder folder(false);
  const Study study = settled(folder.text());
  EXPECT_EQ(study.cells[0].reference.kind, Kind::estimate);
  EXPECT_FALSE(study.cells[0].reference.is_contender);
  EXPECT_EQ(value_of(study, "association.reference"), "(absent)");
  EXPECT_EQ(value_of(study, "association.reference.type"), "incremental_smoother");
  EXPECT_EQ(value_of(study, "association.reference.gate_probability"), "off");
  EXPECT_EQ(study.description.selected_by(0), "the estimate of incremental_smoother, no contender");
  EXPECT_EQ(study.description.estimators.size(), 2u);
  EXPECT_THAT(
      input_error_of([&] { settled(folder.text() + "association.reference: ground_truth\n"); }),
      HasSubstr("config.yaml:4: association.reference: ground_truth, but the data set has "
                "none at frame 0"));
}

TEST(Reference, MayBeAnEstimatorOfItsOwn) {
  const Study study = settled(std::string(kSmallSurvey) + kList +
                              "association: {reference: {type: ekf, gate_probability: 0.99}}\n");
  EXPECT_FALSE(study.cells[0].reference.is_contender);
  EXPECT_EQ(value_of(study, "association.reference.type"), "ekf");
  EXPECT_EQ(value_of(study, "association.reference.gate_probability"), "0.99");
  EXPECT_EQ(study.description.selected_by(0), "the estimate of ekf, no contender");
}

TEST(Reference, ThatIsAContenderIsSaid) {
  const Study study = settled(std::string(kSmallSurvey) + kList + "association.reference: many\n");
  EXPECT_TRUE(study.cells[0].reference.is_contender);
  EXPECT_EQ(value_of(study, "association.reference"), "many");
  EXPECT_EQ(study.description.selected_by(0), "the estimate of many, a contender");
}

TEST(Reference, CanBeSwept) {
  const Study study =
      settled(std::string(kSmallSurvey) + kList +
              "sweep: [{key: association.reference, values: [ground_truth, ekf]}]\n");
  EXPECT_EQ(study.description.selected_by(0), "ground truth");
  EXPECT_EQ(study.description.selected_by(1), "the estimate of ekf, a contender");
}

TEST(Reference, IsOfNoUseWhereNothingIsSelected) {
  const Study own = settled(std::string(kSmallSurvey) + kList + "association.mode: own\n");
  EXPECT_EQ(value_of(own, "association.reference"), "(absent)");
  EXPECT_EQ(own.description.selected_by(0), "");
  const std::string graph = std::string("dataset: {type: simulated_log}\n") + kList;
  EXPECT_EQ(value_of(settled(graph), "association.reference"), "(absent)");
  EXPECT_EQ(settled(graph).description.selected_by(0), "");
  EXPECT_THAT(input_error_of([&] { settled(graph + "association.reference: ekf\n"); }),
              HasSubstr("association.reference: a simulated_log graph has its loops"));
  const std::string both = std::string(kSmallSurvey) + kList + "association.reference: ekf\n" +
                           "sweep: [{key: association.mode, values: [own, shared]}]\n";
  EXPECT_EQ(settled(both).description.selected_by(1), "the estimate of ekf, a contender");
}

TEST(Reference, BadOnesAreRefusedWithTheirKey) {
  const auto refused = [](const std::string& text) {
    return refusal(std::string(kList) + text, test::kComparison);
  };
  EXPECT_THAT(refused("association.reference: {max_iterations: 2}\n"),
              HasSubstr("config.yaml:2: association.reference.type is missing"));
  EXPECT_THAT(refused("association.reference: {type: ekv}\n"),
              HasSubstr("association.reference.type: unknown estimator 'ekv'"));
  EXPECT_THAT(refused("association.reference: {type: ekf, gate_probability: 2}\n"),
              HasSubstr("association.reference.gate_probability"));
  EXPECT_THAT(refused("association.reference: {type: ekf, gate: 2}\n"),
              HasSubstr("unknown key 'association.reference.gate' of ekf"));
  EXPECT_THAT(refused("association.reference: {type: ekf, name: a}\n"),
              HasSubstr("association.reference.name: a reference stands in no table"));
  EXPECT_THAT(refused("association.reference: ground_thruth\n"),
              HasSubstr("did you mean 'ground_truth'?"));
  Settings both = settings_of(std::string(kList) + "association.reference: {type: ekf}\n");
  both.put(parse_override("association.reference=ekf"));
  EXPECT_THAT(input_error_of([&] { configure(both, test::kComparison, builtin_estimators()); }),
              HasSubstr("association.reference: is given as a map, too, by "));
  EXPECT_THAT(refusal("estimators: [{type: ekf, name: ground_truth}]\n", test::kComparison),
              HasSubstr("ground_truth is a word of association.reference"));
}

// By ground truth the pairs tried are those that are truly near, whatever the contenders think.
TEST(Reference, GroundTruthSelectsWhatIsTrulyNear) {
  const std::string noisy = std::regex_replace(
      std::string(kSmallSurvey), std::regex("sigma_theta_rad: 0.01"), "sigma_theta_rad: 0.1");
  const Study study = settled(noisy + "estimators: [{type: ekf}]\n");
  const Configuration& cell = study.cells[0];
  const Recorder recorder(cell);
  const Recording recording = recorder.record(cell, cell.reference, builtin_estimators(), {1, 0});
  const std::vector<Pose>& truth = *recording.ground_truth;
  std::size_t near = 0;
  for (std::size_t k = 1; k < truth.size(); ++k) {
    for (std::size_t i = 0; i < k; ++i) {
      if ((truth[i].position() - truth[k].position()).norm() <= 1.6) ++near;
    }
  }
  EXPECT_EQ(recording.registrations_tried, near);
  // Dead reckoning, which no contender should have to be, selects others.
  test::Script script;
  EstimatorRegistry registry;
  registry.add(test::scripted(script));
  const CandidateReference drifting{Kind::estimate, {"scripted", "scripted", {}}, true};
  EXPECT_NE(recorder.record(cell, drifting, registry, {1, 0}).registrations_tried, near);
}

// Charged where an estimator's own uncertainty selects its loops, and there alone.
TEST(EvaluationOptionsOf, ChargeCandidatesToWhomTheyServe) {
  const auto charged = [](const std::string& text, std::size_t estimator) {
    const Study study = settled(std::string(kSmallSurvey) + kList + text);
    const Configuration& cell = study.cells[0];
    return evaluation_options(cell, cell.estimators[estimator]).own_candidates;
  };
  EXPECT_FALSE(charged("", 0));
  EXPECT_TRUE(charged("association.mode: own\n", 0));
  EXPECT_FALSE(charged("association.reference: many\n", 0));
  EXPECT_TRUE(charged("association.reference: many\n", 1));
  const Configuration run = test::configured(kSmallSurvey);
  EXPECT_TRUE(evaluation_options(run, run.estimators[0]).own_candidates);
  EXPECT_TRUE(evaluation_options(run, run.estimators[0]).newest_covariances);
  const Study without =
      study_of(std::string(kSmallSurvey) + "evaluation.newest_covariance: false\n");
  EXPECT_FALSE(
      evaluation_options(without.cells[0], without.cells[0].estimators[0]).newest_covariances);
}

}  // namespace
}  // namespace fathom
