// What is left of a study, by what its parts took: closed forms over made-up times.

#include "src/harness/study_pace.hpp"

#include <gtest/gtest.h>

namespace fathom {
namespace {

constexpr SharedSurvey kFirst{0, 0};
constexpr SharedSurvey kSecond{0, 1};

FrontEndProgress at(std::size_t pictures, double left_s, double anew = 1.0) {
  FrontEndProgress progress;
  progress.pictures = pictures;
  progress.of_pictures = 100;
  progress.left_s = left_s;
  progress.anew = anew;
  return progress;
}

void pass(StudyPace& pace, const SharedSurvey& survey, double seconds, double anew) {
  pace.front_end_at(pace.begin_front_end(survey), seconds, at(100, 0.0, anew));
}

// Two surveys of three trials with two estimators.
StudyPace study(std::size_t threads = 1) {
  return StudyPace({{{kFirst, 3}, {kSecond, 3}}, {{0, 6}, {1, 6}}}, threads);
}

TEST(StudyPace, SaysNothingBeforeAnythingTells) {
  StudyPace pace = study();
  EXPECT_FALSE(pace.left());
  const std::size_t first = pace.begin_front_end(kFirst);
  EXPECT_FALSE(pace.left());
  FrontEndProgress beginning;
  beginning.of_pictures = 100;
  pace.front_end_at(first, 1.0, beginning);
  EXPECT_FALSE(pace.left());
}

TEST(StudyPace, CountsTheRegistrationsOfAllSurveysByTheFirst) {
  StudyPace pace = study();
  pace.front_end_at(pace.begin_front_end(kFirst), 10.0, at(25, 30.0));
  // The rest of this one, and another of 40 s; runs and later passes are not known.
  ASSERT_TRUE(pace.left());
  EXPECT_DOUBLE_EQ(pace.left()->seconds, 70.0);
  EXPECT_TRUE(pace.left()->is_least);
}

TEST(StudyPace, IsWholeOnceEveryPartWasSeen) {
  StudyPace pace = study();
  pass(pace, kFirst, 40.0, 1.0);
  pace.run_done(0, 1.0);
  pace.run_done(1, 3.0);
  EXPECT_TRUE(pace.left()->is_least);
  pass(pace, kFirst, 2.0, 0.0);
  // A pass of the first survey, one first and two later ones of the second, five runs of each.
  EXPECT_DOUBLE_EQ(pace.left()->seconds, 2.0 + 40.0 + 2 * 2.0 + 5 * 1.0 + 5 * 3.0);
  EXPECT_FALSE(pace.left()->is_least);
  // A survey whose first pictures are not there yet takes what the others took.
  const std::size_t second = pace.begin_front_end(kSecond);
  FrontEndProgress beginning;
  beginning.of_pictures = 100;
  pace.front_end_at(second, 15.0, beginning);
  EXPECT_DOUBLE_EQ(pace.left()->seconds, 2.0 + 25.0 + 2 * 2.0 + 5 * 1.0 + 5 * 3.0);
}

TEST(StudyPace, IsSharedByThreads) {
  StudyPace one = study(1);
  StudyPace two = study(2);
  for (StudyPace* pace : {&one, &two}) {
    pass(*pace, kFirst, 40.0, 1.0);
    pass(*pace, kSecond, 20.0, 1.0);
    pace->run_done(0, 1.0);
  }
  EXPECT_DOUBLE_EQ(two.left()->seconds, 0.5 * one.left()->seconds);
}

// Stopped when three of four pairs were registered, and run again.
TEST(StudyPace, OfASurveyThatWasKnownInPartTheWholeIsReckoned) {
  StudyPace pace({{{kFirst, 1}, {kSecond, 1}}, {}}, 1);
  pass(pace, kFirst, 10.0, 0.25);
  EXPECT_DOUBLE_EQ(pace.left()->seconds, 40.0);
}

TEST(StudyPace, OfSurveysThatAreKnownTheOthersAreAtLeast) {
  constexpr SharedSurvey third{0, 2};
  StudyPace pace({{{kFirst, 1}, {kSecond, 1}, {third, 1}}, {}}, 1);
  pass(pace, kFirst, 3.0, 0.0);
  EXPECT_DOUBLE_EQ(pace.left()->seconds, 6.0);
  EXPECT_TRUE(pace.left()->is_least);
  // One that was not known tells of the others.
  pace.front_end_at(pace.begin_front_end(kSecond), 20.0, at(40, 40.0));
  EXPECT_DOUBLE_EQ(pace.left()->seconds, 40.0 + 60.0);
  EXPECT_FALSE(pace.left()->is_least);
}

TEST(StudyPace, ALastPassTakesItsTimeWhateverTheThreads) {
  StudyPace pace({{{kFirst, 1}}, {}}, 8);
  pace.front_end_at(pace.begin_front_end(kFirst), 1.0, at(2, 59.0));
  EXPECT_DOUBLE_EQ(pace.left()->seconds, 59.0);
}

TEST(StudyPace, ALaterPassIsAsLongAsOthersWere) {
  StudyPace pace({{{kFirst, 3}}, {}}, 1);
  pass(pace, kFirst, 40.0, 1.0);
  pass(pace, kFirst, 2.0, 0.05);
  pace.front_end_at(pace.begin_front_end(kFirst), 0.5, at(50, 28.0, 0.05));
  EXPECT_DOUBLE_EQ(pace.left()->seconds, 1.5);
}

TEST(StudyPace, EndsAtNothing) {
  StudyPace pace({{{kFirst, 1}}, {{4, 1}}}, 1);
  pass(pace, kFirst, 3.0, 1.0);
  pace.run_done(4, 0.5);
  ASSERT_TRUE(pace.left());
  EXPECT_EQ(pace.left()->seconds, 0.0);
  EXPECT_FALSE(pace.left()->is_least);
}

}  // namespace
}  // namespace fathom
