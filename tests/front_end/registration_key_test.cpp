#include "fathom/front_end/registration_key.hpp"

#include <set>

#include <gtest/gtest.h>

namespace fathom {
namespace {

RegistrationKey key_of(const CameraModel& camera, const FeatureOptions& features,
                       const RegistrationOptions& registration) {
  return RegistrationKeys(camera, features, registration).of({1, 2.0}, {3, 4.0}, 5);
}

TEST(RegistrationKeys, TheSameIsTheSame) {
  EXPECT_EQ(key_of({}, {}, {}), key_of({}, {}, {}));
}

TEST(RegistrationKeys, EveryPartOfAPairCounts) {
  const RegistrationKeys keys({}, {}, {});
  std::set<RegistrationKey> different{
      keys.of({1, 2.0}, {3, 4.0}, 5), keys.of({9, 2.0}, {3, 4.0}, 5),
      keys.of({1, 2.1}, {3, 4.0}, 5), keys.of({1, 2.0}, {9, 4.0}, 5),
      keys.of({1, 2.0}, {3, 4.1}, 5), keys.of({1, 2.0}, {3, 4.0}, 9),
      keys.of({3, 4.0}, {1, 2.0}, 5)};
  EXPECT_EQ(different.size(), 7u);
  // Neither half hangs on the other.
  std::set<std::uint64_t> halves;
  for (const RegistrationKey& key : different) halves.insert({key.first, key.second});
  EXPECT_EQ(halves.size(), 14u);
}

TEST(RegistrationKeys, TheSigmaOfAnAltitudeCounts) {
  const RegistrationKeys keys({}, {}, {});
  const auto of = [&](double from_m, double to_m) {
    return keys.of({1, 2.0, {}, from_m}, {3, 4.0, {}, to_m}, 5);
  };
  const std::set<RegistrationKey> different{of(0.0, 0.0), of(0.1, 0.0), of(0.0, 0.1), of(0.1, 0.1),
                                            of(0.2, 0.1)};
  EXPECT_EQ(different.size(), 5u);
  // Where none is stated, keys are what they always were.
  EXPECT_EQ(of(0.0, 0.0), keys.of({1, 2.0}, {3, 4.0}, 5));
}

TEST(RegistrationKeys, TheContentOfAMaskCounts) {
  const auto of = [](const cv::Mat& mask) {
    return RegistrationKeys({}, {}, {}, mask).of({1, 2.0}, {3, 4.0}, 5);
  };
  cv::Mat mask(4, 6, CV_8U, cv::Scalar(255));
  const RegistrationKey whole = of(mask);
  mask.at<unsigned char>(1, 2) = 0;
  const std::set<RegistrationKey> different{of({}), whole, of(mask), of(mask.reshape(1, 6))};
  EXPECT_EQ(different.size(), 4u);
  // Without one, keys are what they always were.
  EXPECT_EQ(of({}), RegistrationKeys({}, {}, {}).of({1, 2.0}, {3, 4.0}, 5));
}

TEST(RegistrationKeys, RollPitchAndTheirSigmaCount) {
  const RegistrationKeys keys({}, {}, {});
  const auto of = [&](const std::optional<MeasuredTilt>& from,
                      const std::optional<MeasuredTilt>& to) {
    return keys.of({1, 2.0, from}, {3, 4.0, to}, 5);
  };
  const MeasuredTilt level{{0.0, 0.0}, 0.0};
  const std::set<RegistrationKey> different{of({}, {}),
                                            of(level, {}),
                                            of({}, level),
                                            of(level, level),
                                            of(MeasuredTilt{{0.1, 0.0}, 0.0}, level),
                                            of(MeasuredTilt{{0.0, 0.1}, 0.0}, level),
                                            of(MeasuredTilt{{0.0, 0.0}, 0.1}, level),
                                            of(level, MeasuredTilt{{0.1, 0.0}, 0.0}),
                                            of(level, MeasuredTilt{{0.0, 0.1}, 0.0}),
                                            of(level, MeasuredTilt{{0.0, 0.0}, 0.1})};
  EXPECT_EQ(different.size(), 10u);
}

TEST(RegistrationKeys, EveryNumberOfTheCameraCounts) {
  std::set<RegistrationKey> different{key_of({}, {}, {})};
  const auto with = [&](auto change) {
    CameraModel camera;
    change(camera);
    different.insert(key_of(camera, {}, {}));
  };
  with([](CameraModel& c) { c.width = 641; });
  with([](CameraModel& c) { c.height = 641; });
  for (double CameraModel::*number :
       {&CameraModel::fx, &CameraModel::fy, &CameraModel::cx, &CameraModel::cy,
        &CameraModel::mount_x_m, &CameraModel::mount_y_m, &CameraModel::mount_yaw_rad}) {
    with([&](CameraModel& c) { c.*number = 77.0; });
  }
  for (std::size_t i = 0; i < 5; ++i) {
    with([&](CameraModel& c) { c.distortion[i] = 1e-9; });
  }
  EXPECT_EQ(different.size(), 1u + 2u + 7u + 5u);
}

TEST(RegistrationKeys, TheModelOfTheLensCounts) {
  std::set<RegistrationKey> different;
  for (const DistortionEntry& entry : distortion_models()) {
    CameraModel camera;
    camera.distortion_model = entry.model;
    different.insert(key_of(camera, {}, {}));
    for (std::size_t i = 0; i < entry.coefficients.size(); ++i) {
      camera.distortion.fill(0.0);
      camera.distortion[i] = 1e-9;
      different.insert(key_of(camera, {}, {}));
    }
  }
  EXPECT_EQ(different.size(), 3u + 5u + 4u + 8u);
}

// A cache that was made before there were other models is not made again.
TEST(RegistrationKeys, OfRadialTangentialLensesAreWhatTheyWere) {
  CameraModel camera;
  camera.distortion = {0.1, -0.2, 0.003, 0.004, 0.5};
  Hash expected;
  expected.add(640).add(480).add(500.0).add(500.0).add(319.5).add(239.5);
  expected.add(0.1).add(-0.2).add(0.003).add(0.004).add(0.5).add(0.0).add(0.0).add(0.0);
  Hash hash;
  camera.add_to(hash);
  EXPECT_EQ(hash.value(), expected.value());
}

// Sets the key to the first of some values that it takes and that is new to it.
bool change(OptionTable& table, const std::string& key) {
  const std::string before = table.value(key);
  for (const char* value :
       {"0.5", "0.25", "3", "7", "77", "true", "false", "orb", "paper", "inliers"}) {
    try {
      table.set(key, OptionValue::scalar(value));
    } catch (const InputError&) {
      continue;
    }
    if (table.value(key) != before) return true;
  }
  return false;
}

TEST(RegistrationKeys, EveryOptionCounts) {
  const auto describe = [](OptionTable& table, FeatureOptions& features,
                           RegistrationOptions& registration) {
    table.group("features", features);
    registration.describe(table);
  };
  OptionTable defaults;
  FeatureOptions default_features;
  RegistrationOptions default_registration;
  describe(defaults, default_features, default_registration);
  const std::vector<std::string> keys = defaults.keys();
  ASSERT_GT(keys.size(), 12u);
  std::set<RegistrationKey> different{key_of({}, {}, {})};
  for (const std::string& key : keys) {
    OptionTable table;
    FeatureOptions features;
    RegistrationOptions registration;
    describe(table, features, registration);
    ASSERT_TRUE(change(table, key)) << key;
    EXPECT_TRUE(different.insert(key_of({}, features, registration)).second) << key;
  }
}

}  // namespace
}  // namespace fathom
