// Every tuned number is at work: changed alone, it changes some registration.

#include "fathom/vision/registration_tuning.hpp"

#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/core/text.hpp"
#include "fathom/vision/registration.hpp"
#include "vision/labelled.hpp"
#include "vision/textured_floor.hpp"

namespace fathom {
namespace {

constexpr double kAltitudeM = 1.5;
const Pose kMotion{0.35, -0.12, 0.3};

Camera small_camera() {
  CameraModel model;
  model.width = 240;
  model.height = 180;
  model.fx = model.fy = 190.0;
  model.cx = 119.5;
  model.cy = 89.5;
  return Camera(model);
}

struct PicturePair {
  cv::Mat from, to;
};

// Of one floor from two poses, with noise of a sensor.
PicturePair pictures(double noise_sigma) {
  static const TexturedFloor floor(1200, 0.004, 3);
  PicturePair pair{floor.seen(small_camera(), {}, kAltitudeM),
                   floor.seen(small_camera(), kMotion, kAltitudeM)};
  cv::RNG random(5);
  for (cv::Mat* picture : {&pair.from, &pair.to}) {
    cv::Mat noisy(picture->size(), CV_32F);
    random.fill(noisy, cv::RNG::NORMAL, 0.0, noise_sigma);
    cv::Mat sum;
    picture->convertTo(sum, CV_32F, noise_sigma > 0.0 ? 0.4 : 1.0, 20.0);
    sum += noisy;
    sum.convertTo(*picture, CV_8U);
  }
  return pair;
}

// Nine matches in ten lie so close together that two of them fix no heading.
FloorFeatures crowded(const Pose& z, double noise_m) {
  RandomStream random(7);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 200; ++i) {
    const double reach_m = i < 180 ? 0.005 : 1.0;
    const double x = random.uniform(-reach_m, reach_m);
    const Eigen::Vector2d point(x, random.uniform(-reach_m, reach_m));
    const double dx = noise_m * random.normal();
    points.push_back(transform(z, point) + Eigen::Vector2d(dx, noise_m * random.normal()));
  }
  return test::labelled(points);
}

// A square lattice, each point of which is taken for its own image or that of a neighbour.
FloorFeatures lattice(bool is_shifted) {
  RandomStream random(6);
  constexpr double kSpacingM = 0.12;
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector2d point = kSpacingM * Eigen::Vector2d(i % 20 - 10, i / 20 - 10);
    const auto column = static_cast<double>(random.index(3));
    const Eigen::Vector2d shift = kSpacingM * Eigen::Vector2d(column, double(random.index(3)));
    points.push_back(is_shifted ? transform(kMotion, point + shift) : point);
  }
  return test::labelled(points);
}

void add(std::string& text, const Registration& registration) {
  const Evidence& e = registration.evidence;
  for (const double number :
       {double(registration.found), registration.motion.x, registration.motion.theta,
        registration.covariance(0, 0), registration.covariance(2, 2), registration.rms_m,
        double(registration.putative.size()), double(registration.inliers.size()),
        double(e.support), double(e.places), double(e.rival_places), e.false_alarms}) {
    text += exact(number) + ' ';
  }
}

struct FeaturePair {
  FloorFeatures from, to;
};

FeaturePair seen(double noise_sigma, const FeatureTuning& tuning) {
  const FeatureExtractor extractor({}, tuning);
  const PicturePair pair = pictures(noise_sigma);
  return {on_floor(extractor.extract(pair.from), small_camera(), kAltitudeM),
          on_floor(extractor.extract(pair.to), small_camera(), kAltitudeM)};
}

// All that some registrations give.
std::string results(const RegistrationTuning& tuning, const std::vector<FeaturePair>& pairs) {
  RegistrationOptions options;
  options.tuning = tuning;
  options.ransac.max_error_m = 0.03;
  std::string text;
  const auto register_by = [&](const FeaturePair& pair, DecisionOptions::Method method) {
    options.decision.method = method;
    add(text, register_pair(pair.from, pair.to, options, 1));
  };
  for (const FeaturePair& pair : pairs) {
    register_by(pair, DecisionOptions::Method::false_alarms);
    register_by(pair, DecisionOptions::Method::inliers);
  }
  register_by({lattice(true), lattice(false)}, DecisionOptions::Method::false_alarms);
  options.ransac.iterations = 3;
  register_by({crowded(kMotion, 0.002), crowded({}, 0.0)}, DecisionOptions::Method::inliers);
  register_by({crowded(kMotion, 0.012), crowded({}, 0.0)}, DecisionOptions::Method::inliers);
  return text;
}

// Far enough from the default to be seen; of those not named half as much again.
std::string changed(const std::string& key, const std::string& value) {
  static const std::map<std::string, std::string> far{{"features.least_floor", "50"},
                                                      {"features.least_blur_px", "20"},
                                                      {"features.most_blur_px", "0.5"},
                                                      {"features.noise_in_fine_band", "0.5"},
                                                      {"matching.turn_tolerance_rad", "0.02"},
                                                      {"ransac.redraws", "1"},
                                                      {"ransac.refit_rounds", "0"},
                                                      {"decision.support_rounds", "0"},
                                                      {"decision.most_places", "3"},
                                                      {"decision.rival_distance", "20"},
                                                      {"decision.grid_spacing", "10"},
                                                      {"decision.rival_share", "0.001"},
                                                      {"fit.gate", "3"},
                                                      {"fit.rounds", "1"},
                                                      {"covariance.least_clusters", "1000"}};
  const auto found = far.find(key);
  return found != far.end() ? found->second : number_text(1.5 * parse_real(value).value());
}

TEST(RegistrationTuning, EveryNumberIsAtWork) {
  const std::vector<FeaturePair> pairs{seen(0.0, {}), seen(9.0, {})};
  const std::string defaults = results({}, pairs);
  ASSERT_EQ(results({}, pairs), defaults);
  RegistrationTuning named;
  OptionTable names;
  named.describe(names);
  for (const std::string& key : names.keys()) {
    RegistrationTuning tuning;
    OptionTable table;
    tuning.describe(table);
    table.set(key, OptionValue::scalar(changed(key, table.value(key))));
    const std::string found =
        key.starts_with("features.")
            ? results(tuning, {seen(0.0, tuning.features), seen(9.0, tuning.features)})
            : results(tuning, pairs);
    EXPECT_TRUE(found != defaults) << key;
  }
}

TEST(RegistrationTuning, SaysOfEveryNumberWhatItIs) {
  RegistrationTuning tuning;
  OptionTable table;
  tuning.describe(table);
  EXPECT_EQ(table.keys().size(), 30U);
  for (const OptionDescription& description : table.descriptions()) {
    EXPECT_FALSE(description.range.empty()) << description.key;
    EXPECT_GE(description.help.size(), 20U) << description.key;
  }
}

}  // namespace
}  // namespace fathom
