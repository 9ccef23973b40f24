#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/front_end/calibration.hpp"
#include "front_end/turning_survey.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::uint64_t kOrders = 8;

// What pictures show that were taken at the times of others, of which `shown` says whose.
CalibrationInput in_order(const TurningSurvey& survey, std::uint64_t seed,
                          const std::vector<std::size_t>& shown) {
  CalibrationInput input = survey.input(seed);
  RandomStream stream(seed, "order");
  const std::vector<std::int64_t> times_ns = input.frame_times_ns;
  const auto camera_at = [&](std::size_t frame) {
    return compose(survey.truth(1e-9 * static_cast<double>(times_ns[frame])), survey.mount);
  };
  input.frame_times_ns.resize(shown.size());
  input.motions.clear();
  for (std::size_t i = 1; i < shown.size(); ++i) {
    Pose motion = between(camera_at(shown[i - 1]), camera_at(shown[i]));
    // Pictures that far apart do not overlap.
    if (motion.position().norm() > 1.0) continue;
    motion.x += survey.registration_noise_m * stream.normal();
    motion.y += survey.registration_noise_m * stream.normal();
    input.motions.push_back({i - 1, i, times_ns[i - 1], times_ns[i], motion});
  }
  return input;
}

std::vector<std::size_t> as_taken(std::size_t count) {
  std::vector<std::size_t> shown(count);
  for (std::size_t i = 0; i < count; ++i) shown[i] = i;
  return shown;
}

TEST(PictureOrder, NamesPicturesThatAreExchanged) {
  const TurningSurvey survey;
  for (std::uint64_t seed = 0; seed < kOrders; ++seed) {
    std::vector<std::size_t> shown = as_taken(survey.pictures);
    for (const std::size_t i : {20U, 70U, 71U}) std::swap(shown[i], shown[i + 1]);
    EXPECT_THAT(
        calibrate(in_order(survey, seed, shown)).findings,
        ElementsAre(AllOf(HasSubstr("picture 21 belongs 1 place later, picture 22 belongs 1 "
                                    "place earlier, "),
                          HasSubstr("picture 73 belongs 2 places earlier"))))
        << seed;
  }
}

TEST(PictureOrder, NamesACounterThatRolledOver) {
  const TurningSurvey survey;
  constexpr std::size_t kFirst = 103;
  for (std::uint64_t seed = 0; seed < kOrders; ++seed) {
    std::vector<std::size_t> shown;
    for (std::size_t i = 0; i < survey.pictures; ++i) {
      shown.push_back((i + survey.pictures - kFirst) % survey.pictures);
    }
    const Calibration found = calibrate(in_order(survey, seed, shown));
    EXPECT_THAT(found.findings,
                ElementsAre(AllOf(HasSubstr("rolled over"), HasSubstr("47 places later"),
                                  HasSubstr("103 places earlier"))))
        << seed;
    ASSERT_TRUE(found.set_up);
    ASSERT_EQ(found.set_up->moved.size(), 2U);
    EXPECT_NEAR(static_cast<double>(found.set_up->moved[1].first), kFirst, 2.0);
  }
}

TEST(PictureOrder, NamesWherePicturesAreMissing) {
  const TurningSurvey survey;
  for (std::uint64_t seed = 0; seed < kOrders; ++seed) {
    for (const std::size_t missing : {1U, 12U}) {
      std::vector<std::size_t> shown = as_taken(survey.pictures);
      shown.erase(shown.begin() + 60, shown.begin() + 60 + static_cast<std::ptrdiff_t>(missing));
      const Calibration found = calibrate(in_order(survey, seed, shown));
      EXPECT_THAT(found.findings, ElementsAre(HasSubstr("pictures are missing"))) << seed;
      ASSERT_TRUE(found.set_up);
      ASSERT_EQ(found.set_up->moved.size(), 1U);
      EXPECT_NEAR(static_cast<double>(found.set_up->moved[0].first), 60.0, 3.0);
      EXPECT_EQ(found.set_up->moved[0].places, static_cast<std::ptrdiff_t>(missing));
    }
  }
}

// A way that is the same from its end: the right clock lies between the offsets that are tried
// first, the one of the pictures in reverse order is 0.
TEST(PictureOrder, ALateClockIsNoReverseOrder) {
  TurningSurvey survey;
  survey.speed_change = 0.0;
  for (const double late_s : {0.2, 0.7}) {
    survey.clock_late_s = late_s;
    survey.even_about_s = 0.5 * (0.5 * static_cast<double>(survey.pictures - 1) - late_s);
    for (std::uint64_t seed = 0; seed < kOrders; ++seed) {
      const Calibration found = calibrate(survey.input(seed));
      ASSERT_TRUE(found.set_up);
      EXPECT_FALSE(found.set_up->is_reversed) << late_s << " s, seed " << seed;
      EXPECT_NEAR(found.set_up->time_offset_s.value, -late_s, 0.03);
    }
  }
}

// Neither registrations that are wrong nor a clock that is far off, nor a camera that is turned,
// is an order.
TEST(PictureOrder, NothingElseIsOne) {
  TurningSurvey survey;
  survey.mount = {0.2, -0.1, 0.3};
  survey.clock_late_s = 1.4;
  for (std::uint64_t seed = 0; seed < kOrders; ++seed) {
    CalibrationInput input = survey.input(seed);
    RandomStream stream(seed, "wrong");
    for (std::size_t i = 0; i < input.motions.size(); i += 10) {
      input.motions[i].camera = {stream.normal(), stream.normal(), stream.normal()};
    }
    const Calibration found = calibrate(input);
    ASSERT_TRUE(found.set_up);
    EXPECT_THAT(found.set_up->moved, IsEmpty()) << seed;
  }
}

}  // namespace
}  // namespace fathom::test
