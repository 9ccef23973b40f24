// The part of a configuration that `compare` has: a list of estimators.

#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"

namespace fathom {
namespace {

using test::configured;
using test::kComparison;
using test::kSingle;
using test::refusal;
using test::settings_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(ConfigureComparison, WithoutAListTakesEveryEstimator) {
  const Configuration configuration = configured("seed: 1\n", kComparison);
  ASSERT_EQ(configuration.estimators.size(), builtin_estimators().entries().size());
  for (std::size_t i = 0; i < configuration.estimators.size(); ++i) {
    EXPECT_EQ(configuration.estimators[i].type, builtin_estimators().entries()[i].name);
  }
  EXPECT_EQ(configuration.reference.kind, CandidateReference::Kind::automatic);
  EXPECT_FALSE(configuration.reference.is_contender);
}

TEST(ConfigureComparison, TakesAListWithNamesAndAReference) {
  const Configuration configuration = configured(
      "estimators:\n"
      "  - {type: ekf}\n"
      "  - {type: trajectory_iekf, name: one, max_iterations: 1}\n"
      "  - {type: trajectory_iekf, name: many}\n"
      "association: {reference: many}\n",
      kComparison);
  ASSERT_EQ(configuration.estimators.size(), 3u);
  EXPECT_EQ(configuration.estimators[0].name, "ekf");
  EXPECT_EQ(configuration.estimators[1].name, "one");
  EXPECT_EQ(configuration.estimators[1].type, "trajectory_iekf");
  EXPECT_THAT(configuration.estimators[1].values.at("max_iterations").items, ElementsAre("1"));
  EXPECT_TRUE(configuration.estimators[2].values.empty());
  EXPECT_EQ(configuration.reference.kind, CandidateReference::Kind::estimate);
  EXPECT_EQ(configuration.reference.estimator.name, "many");
  EXPECT_TRUE(configuration.reference.is_contender);
}

TEST(ConfigureComparison, AnOverrideChangesOrAppendsAnItem) {
  Settings settings = settings_of("estimators: [{type: ekf}]\n");
  settings.put(parse_override("estimators.0.name=first"));
  settings.put(parse_override("estimators.1.type=ceres_pose_graph"));
  const Configuration configuration = configure(settings, kComparison, builtin_estimators());
  ASSERT_EQ(configuration.estimators.size(), 2u);
  EXPECT_EQ(configuration.estimators[0].name, "first");
  EXPECT_EQ(configuration.estimators[1].type, "ceres_pose_graph");
}

TEST(ConfigureComparison, RefusesWhatIsNoListOfEstimators) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"estimators: ekf\n", "estimators: expected a list of maps, such as '- {type: ekf}'"},
      {"estimators: [ekf]\n", "estimators: expected a list of maps"},
      {"estimators: []\n", "estimators: expected a list of maps"},
      {"estimators: {type: ekf}\n", "estimators.type: expected a list of maps"},
      {"estimators.0: ekf\n", "estimators.0: expected a list of maps"},
      {"estimators.1.type: ekf\n", "numbered from 0 without a gap"},
      {"estimators: [{}, {type: ekf}]\n", "estimators.0: the map is empty"},
      {"estimators: [{type: ekf}]\nestimators.00.name: x\n", "config.yaml:2: estimators.00.name"},
      {"estimators: [{type: ekf}, {type: ekf}]\n", "two estimators are called 'ekf'"},
      {"estimators: [{type: ekf, name: ceres_pose_graph}, {type: ceres_pose_graph}]\n",
       "two estimators are called 'ceres_pose_graph'"},
      {"estimators: [{type: ekf, max_iteration: 1}]\n",
       "did you mean 'estimators.0.max_iterations'?"},
      {"estimators: [{type: ekf, name: [a]}]\n", "estimators.0.name: expected a single word"}};
  for (const auto& [text, message] : cases) {
    EXPECT_THAT(refusal(text, kComparison), HasSubstr(message)) << text;
  }
}

TEST(ConfigureComparison, ANameMustBeAFolderName) {
  for (const std::string name : {"''", "a/b", "..", ".", "'a b'", "table.txt", "'a\\b'"}) {
    EXPECT_THAT(refusal("estimators: [{type: ekf, name: " + name + "}]\n", kComparison),
                HasSubstr("config.yaml:1: estimators.0.name: it names a folder too"))
        << name;
  }
}

TEST(ConfigureComparison, TheReferenceMustBeOneOfTheNames) {
  const std::string list = "estimators: [{type: ekf, name: a_filter}, {type: ceres_pose_graph}]\n";
  EXPECT_THAT(refusal(list + "association: {reference: a_fliter}\n", kComparison),
              HasSubstr("config.yaml:2: association.reference: no estimator is called 'a_fliter'; "
                        "did you mean 'a_filter'?"));
  EXPECT_THAT(refusal(list + "association: {reference: [a]}\n", kComparison),
              HasSubstr("association.reference: expected a single word"));
  EXPECT_THAT(refusal(list + "association: {refrence: a}\n", kComparison),
              HasSubstr("did you mean 'association.reference'?"));
}

TEST(ConfigureComparison, KeysOfTheOtherKindAreRefused) {
  EXPECT_THAT(refusal("estimator: {type: ekf}\n", kComparison),
              HasSubstr("unknown key 'estimator.type': 'compare' takes a list"));
  EXPECT_THAT(refusal("estimators: [{type: ekf}]\n", kSingle),
              HasSubstr("a list of estimators is for 'compare'"));
  EXPECT_THAT(refusal("association: {reference: ekf}\n", kSingle),
              HasSubstr("config.yaml:1: unknown key 'association.reference'"));
}

TEST(KindOf, IsAComparisonWhereAListIs) {
  EXPECT_EQ(kind_of(settings_of("")), kSingle);
  EXPECT_EQ(kind_of(settings_of("estimator: {type: ekf}\nseed: 1\n")), kSingle);
  EXPECT_EQ(kind_of(settings_of("estimators: [{name: a}]\n")), kComparison);
  EXPECT_EQ(kind_of(settings_of("association: {reference: a}\n")), kComparison);
  EXPECT_EQ(kind_of(settings_of("estimators: ekf\n")), kComparison);
}

}  // namespace
}  // namespace fathom
