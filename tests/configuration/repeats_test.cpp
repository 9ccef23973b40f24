// Surveys and trials of a study: what they are called, what they count, and which are refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/study_of.hpp"

namespace fathom {
namespace {

using test::refusal_of_study;
using test::study_of;
using ::testing::HasSubstr;

TEST(Repeats, SaysWhatItsRepeatsAre) {
  const auto said = [](const std::string& text) {
    const StudyDescription study = study_of(text + "trials: 3\n").description;
    return repeats_text(study.repetition_of(0), study.surveys, study.trials);
  };
  EXPECT_EQ(said(""), "1 survey × 3 trials");
  EXPECT_EQ(said("surveys: 4\n"), "4 surveys × 3 trials");
  EXPECT_EQ(said("dataset: {type: simulated_log}\n"), "3 trials");
  EXPECT_EQ(said("dataset: {type: image_folder, path: a}\n"), "one set of pictures, 3 trials");
  EXPECT_EQ(said("dataset: {type: g2o, path: a}\nassociation: {false_loops: {share: 0.1}}\n"),
            "one graph, 3 trials");
  const StudyDescription swept =
      study_of("sweep: [{key: dataset.type, values: [simulated, simulated_log]}]\n").description;
  EXPECT_EQ(swept.repetition_of(0), Repetition::surveys);
  EXPECT_EQ(swept.repetition_of(1), Repetition::logs);
}

TEST(Repeats, CountsTheDrawsThatAreIndependent) {
  EXPECT_EQ(independent_draws(Repetition::surveys, 10, 100), 10u);
  EXPECT_EQ(independent_draws(Repetition::surveys, 1, 100), 1u);
  EXPECT_EQ(independent_draws(Repetition::pictures, 1, 100), 1u);
  EXPECT_EQ(independent_draws(Repetition::graph, 1, 100), 1u);
  EXPECT_EQ(independent_draws(Repetition::logs, 1, 100), 100u);
  EXPECT_EQ(independent_draws(Repetition::surveys, 0, 0), 0u);
}

TEST(Repeats, RefusesSurveysWhereNothingIsDrawnForThem) {
  const std::string one = "; expected 1";
  EXPECT_THAT(refusal_of_study("surveys: 2\ndataset: {type: image_folder, path: a}\n"),
              HasSubstr(":1: surveys: an image_folder is one set of pictures, of which nothing is "
                        "drawn again" +
                        one));
  EXPECT_THAT(refusal_of_study("surveys: 2\ndataset: {type: simulated_log}\n"),
              HasSubstr("surveys: simulated_log draws everything in each of its trials" + one));
  EXPECT_THAT(refusal_of_study("surveys: 2\ndataset: {type: g2o, path: a}\n"),
              HasSubstr("surveys: a g2o graph is always the same" + one));
  const std::string over_a_picture =
      "surveys: 2\ndataset: {world: {picture: a.png}, altitude: {altimeter_sigma_m: ";
  EXPECT_THAT(refusal_of_study(over_a_picture + "0}}\n"), HasSubstr("leave nothing to draw" + one));
  EXPECT_EQ(study_of(over_a_picture + "0.01}}\n").description.surveys, 2u);
  EXPECT_THAT(refusal_of_study("surveys: 2\nsweep: [{key: dataset.type, values: [simulated, "
                               "simulated_log]}]\n"),
              HasSubstr("surveys: simulated_log draws everything"));
}

// A sweep of false loops begins without any; its other cells draw them.
TEST(Repeats, TrialsOfAGraphAreForAnyCellWithFalseLoops) {
  const std::string swept =
      "trials: 8\ndataset: {type: g2o, path: a}\n"
      "sweep: [{key: association.false_loops.share, values: ";
  EXPECT_EQ(study_of(swept + "[0, 0.3]}]\n").description.trials, 8u);
  EXPECT_THAT(refusal_of_study(swept + "[0]}]\n"),
              HasSubstr(":1: trials: a pose graph without false loops has nothing to draw"));
}

TEST(Repeats, RefusesMoreRunsThanAStudyCanHave) {
  EXPECT_THAT(refusal_of_study("surveys: 0\n"), HasSubstr("surveys: expected a whole number >= 1"));
  EXPECT_THAT(
      refusal_of_study("trials: 2000\nsurveys: 1000\n"),
      HasSubstr(":2: surveys: 1000 of 2000 trials each are too many; expected surveys times "
                "trials of at most 1000000"));
  EXPECT_EQ(study_of("trials: 1000\nsurveys: 1000\n").description.surveys, 1000u);
  EXPECT_THAT(refusal_of_study("sweep: [{key: surveys, values: [1, 2]}]\n"),
              HasSubstr("surveys is the study's own and cannot be swept"));
}

}  // namespace
}  // namespace fathom
