// Standard deviations that the survey's own loops give.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"
#include "fathom/core/text.hpp"
#include "fathom/harness/found_sigma.hpp"
#include "harness/recorded.hpp"
#include "harness/small_config.hpp"

namespace fathom {
namespace {

using test::configured;
using test::recorded;
using ::testing::HasSubstr;
using Part = VarianceComponent::Part;

Recording recorded_with(const std::string& lines) {
  return recorded(configured(std::string(test::kSmallSurvey) + lines));
}

const std::string kTold = "front_end.tells_shared_errors: true\n";
const std::string kEstimated =
    "front_end.covariance.altitude_sigma_m: estimated\n"
    "front_end.covariance.tilt_sigma_rad: estimated\n"
    "front_end.covariance.own_factor: estimated\n";

TEST(FoundSigmas, AreNoneWhereAllIsStatedAndPicturesTellNothing) {
  const Recording recording = recorded_with("");
  EXPECT_TRUE(recording.found_sigmas.empty());
  EXPECT_FALSE(recording.log.tells_shared_errors());
  EXPECT_TRUE(recorded_with(kTold).log.tells_shared_errors());
}

// Telling changes nothing of what a log says to whoever does not ask.
TEST(FoundSigmas, TellingLeavesTheLogToTheLastBit) {
  EXPECT_EQ(to_g2o(recorded_with(kTold).log), to_g2o(recorded_with("").log));
}

// The recording is that of the values it found, but for rounding.
TEST(FoundSigmas, ARunWithThemStatedIsTheSame) {
  const Recording estimated = recorded_with(kEstimated);
  ASSERT_EQ(estimated.found_sigmas.size(), 3u);
  std::string stated = kTold;
  for (const FoundSigma& sigma : estimated.found_sigmas) {
    ASSERT_TRUE(sigma.is_found) << words(sigma);
    EXPECT_LE(sigma.low, sigma.in_force);
    EXPECT_GE(sigma.high, sigma.in_force);
    EXPECT_THAT(words(sigma), HasSubstr(" from "));
    const char* key = sigma.part == Part::tilt       ? "tilt_sigma_rad"
                      : sigma.part == Part::altitude ? "altitude_sigma_m"
                                                     : "own_factor";
    stated += std::string("front_end.covariance.") + key + ": " + exact(sigma.in_force) + "\n";
  }
  const Recording again = recorded_with(stated);
  ASSERT_EQ(again.log.registration_count(), estimated.log.registration_count());
  for (std::size_t k = 1; k < again.log.size(); ++k) {
    const auto& registrations = again.log.arrival(k).registrations;
    for (std::size_t j = 0; j < registrations.size(); ++j) {
      const RelativePose& z = estimated.log.arrival(k).registrations[j];
      EXPECT_EQ(registrations[j].motion, z.motion);
      EXPECT_TRUE(registrations[j].information.isApprox(z.information, 1e-9));
      EXPECT_TRUE(registrations[j].shared->own.isApprox(z.shared->own, 1e-9));
    }
  }
}

// Without a loop nothing can be said, and what is assumed stays.
TEST(FoundSigmas, WithoutLoopsTheyAreAssumed) {
  std::string survey = test::kSmallSurvey;
  survey.replace(survey.find("max_distance_m: 1.6"), 19, "max_distance_m: 1e-6");
  const Recording recording = recorded(configured(survey + kEstimated));
  ASSERT_EQ(recording.found_sigmas.size(), 3u);
  for (const FoundSigma& sigma : recording.found_sigmas) {
    EXPECT_FALSE(sigma.is_found);
    EXPECT_THAT(words(sigma), HasSubstr("assumed: 0 loops do not tell"));
  }
  EXPECT_EQ(recording.found_sigmas[1].in_force, CovarianceOptions::kAssumedTiltRad);
}

}  // namespace
}  // namespace fathom
