// What a process of its own sends back may be anything: it is a run of the log, or refused.
#include "src/harness/run_bytes.hpp"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/estimators/builtin.hpp"
#include "harness/square_log.hpp"

namespace fathom {
namespace {

using ::testing::HasSubstr;

MeasurementLog log_with_heading() {
  MeasurementLog log = test::square_log();
  log.add_absolute(AbsolutePose::heading(7, 0.3, 0.1));
  return log;
}

Run run_of_log() {
  return replay(log_with_heading(), builtin_estimators().find("ekf"), {}, {});
}

std::string refusal_of_bytes(const std::string& bytes) {
  try {
    run_of(bytes, log_with_heading(), {});
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

std::string refusal_of_run(const std::function<void(Run&)>& spoil) {
  Run run = run_of_log();
  spoil(run);
  return refusal_of_bytes(bytes_of(run));
}

TEST(RunBytes, ARunComesBackAsItWas) {
  const fathom::Run run = run_of_log();
  const fathom::Run again = run_of(bytes_of(run), log_with_heading(), {});
  EXPECT_EQ(again.trajectory, run.trajectory);
  EXPECT_EQ(again.covariances, run.covariances);
  ASSERT_EQ(again.loops.size(), run.loops.size());
  EXPECT_EQ(again.loops[1].nis, run.loops[1].nis);
  EXPECT_EQ(again.costs.update_ms, run.costs.update_ms);
  EXPECT_EQ(bytes_of(again), bytes_of(run));
}

TEST(RunBytes, AFlagIsZeroOrOne) {
  const fathom::Run run = run_of_log();
  std::string bytes = bytes_of(run);
  // Behind the trajectory: whether there are covariances.
  bytes[sizeof(std::size_t) + run.trajectory.size() * sizeof(Pose)] = 2;
  EXPECT_THAT(refusal_of_bytes(bytes), HasSubstr("flag"));
}

TEST(RunBytes, AWordIsOneOfItsKind) {
  EXPECT_THAT(
      refusal_of_run([](fathom::Run& run) { run.loops[0].fate = static_cast<LoopFate>(7); }),
      HasSubstr("word"));
  EXPECT_THAT(refusal_of_run([](fathom::Run& run) { run.outcome = static_cast<Outcome>(-1); }),
              HasSubstr("word"));
}

TEST(RunBytes, ADecisionIsOnAMeasurementOfTheLog) {
  EXPECT_EQ(refusal_of_run([](fathom::Run&) {}), "");
  EXPECT_EQ(refusal_of_run([](fathom::Run& run) { std::swap(run.loops[0].from, run.loops[0].to); }),
            "");
  EXPECT_THAT(refusal_of_run([](fathom::Run& run) { run.loops[2].from = 1'000'000; }),
              HasSubstr("not of this log"));
  EXPECT_THAT(refusal_of_run([](fathom::Run& run) { run.absolute[0].keyframe = 8; }),
              HasSubstr("not of this log"));
  EXPECT_THAT(refusal_of_run([](fathom::Run& run) { run.loops.pop_back(); }),
              HasSubstr("not of this log"));
}

TEST(RunBytes, CovariancesAreOfTheMotionsThatWereAskedFor) {
  ReplayOptions asked;
  asked.motions = {{MotionsOver::anchors, 1.0, {{0, 3}, {0, 4}}, {}}};
  fathom::Run run = run_of_log();
  run.motions = asked.motions;
  run.motions[0].covariances.resize(1, Eigen::Matrix3d::Identity());
  EXPECT_ANY_THROW(run_of(bytes_of(run), log_with_heading(), asked));
  run.motions[0].covariances.clear();
  EXPECT_NO_THROW(run_of(bytes_of(run), log_with_heading(), asked));
}

}  // namespace
}  // namespace fathom
