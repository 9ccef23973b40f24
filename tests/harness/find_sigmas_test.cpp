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

// As nothing states them, all are estimated.
const std::string kStated =
    "front_end.covariance.altitude_sigma_m: 0\n"
    "front_end.covariance.own_factor: 1\n";
const std::string kLevel = kStated + "front_end.covariance.tilt_sigma_rad: 0\n";
const std::string kTilts = kStated + "front_end.covariance.tilt_sigma_rad: 0.005\n";

TEST(FoundSigmas, AreNoneWhereAllIsStated) {
  const Recording level = recorded_with(kLevel);
  EXPECT_TRUE(level.found_sigmas.empty());
  EXPECT_FALSE(level.log.tells_shared_errors());
  const Recording tilts = recorded_with(kTilts);
  EXPECT_TRUE(tilts.found_sigmas.empty());
  EXPECT_TRUE(tilts.log.tells_shared_errors());
}

// The recording is that of the values it found, but for rounding.
TEST(FoundSigmas, ARunWithThemStatedIsTheSame) {
  const Recording estimated = recorded_with("");
  ASSERT_EQ(estimated.found_sigmas.size(), 3u);
  std::string stated;
  for (const FoundSigma& sigma : estimated.found_sigmas) {
    ASSERT_TRUE(sigma.is_found()) << words(sigma);
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
  const Recording recording = recorded(configured(survey));
  ASSERT_EQ(recording.found_sigmas.size(), 3u);
  for (const FoundSigma& sigma : recording.found_sigmas) {
    EXPECT_FALSE(sigma.is_found());
    EXPECT_THAT(words(sigma), HasSubstr(" assumed: 0 loops do not tell"));
  }
  EXPECT_EQ(recording.found_sigmas[1].in_force, CovarianceOptions::kAssumedTiltRad);
}

}  // namespace
}  // namespace fathom
