// Surveys of shipped configurations, with nothing wrong: what looks for faults changes nothing.

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "fathom/configuration/study.hpp"
#include "fathom/datasets/series_outliers.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/front_end/keyframes.hpp"
#include "fathom/geometry/pose.hpp"
#include "fathom/harness/survey.hpp"
#include "support/data.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

class ShippedSurveys : public testing::TestWithParam<const char*> {
 protected:
  // Those of pictures that are recorded lie beside the checkout, if at all.
  void SetUp() override {
    const fs::path path = fs::path(FATHOM_SOURCE_DIR) / "configs" / GetParam();
    const Settings settings = read_settings(path);
    const bool is_study = settings.find("estimators.0.type") != nullptr;
    Configuration configuration =
        is_study ? configure_study(settings, builtin_estimators()).cells.front()
                 : configure(settings, ConfigurationKind::single, builtin_estimators());
    if (configuration.dataset.type == "image_folder") {
      FATHOM_REQUIRE_DATA("copr");
      configuration.dataset.values["path"] = OptionValue::scalar(test::data_path("copr").string());
    }
    survey = std::make_unique<Survey>(configuration);
  }

  const FrameSource& frames() const { return survey->measured(); }

  std::unique_ptr<Survey> survey;
};

// The share of the smaller footprint alone decides.
std::vector<std::size_t> by_overlap_alone(const FrameSource& source, double kept_overlap) {
  std::vector<std::size_t> keyframes{0};
  Pose motion;
  for (std::size_t i = 1; i < source.size(); ++i) {
    motion = compose(motion, source.info(i).motion->mean);
    const std::size_t last = keyframes.back();
    if (footprint_overlap(source.camera(), source.info(last).stance(), source.info(i).stance(),
                          motion) >= kept_overlap) {
      continue;
    }
    if (i - 1 > last) --i;
    keyframes.push_back(i);
    motion = Pose{};
  }
  return keyframes;
}

TEST_P(ShippedSurveys, KeyframesAreThoseOfOverlapAlone) {
  if (!frames().has_odometry()) return;  // visual odometry has the pictures register first
  for (const double kept_overlap : {0.6, 0.85, 0.95}) {
    KeyframeOptions options;
    options.kept_overlap = kept_overlap;
    KeyframeSchedule schedule(frames(), options);
    std::vector<std::size_t> keyframes;
    while (const auto frame = schedule.frame(keyframes.size())) keyframes.push_back(*frame);
    EXPECT_EQ(keyframes, by_overlap_alone(frames(), kept_overlap)) << kept_overlap;
  }
}

TEST_P(ShippedSurveys, NoAltitudeIsAnOutlier) {
  std::vector<std::int64_t> times_ns;
  std::vector<double> logarithms;
  for (std::size_t i = 0; i < frames().size(); ++i) {
    times_ns.push_back(frames().info(i).time_ns);
    logarithms.push_back(std::log(frames().info(i).altitude_m));
  }
  constexpr double kAsAnImageFolder = 0.36;
  EXPECT_EQ(kept_values(times_ns, logarithms, kAsAnImageFolder),
            std::vector<bool>(times_ns.size(), true));
}

INSTANTIATE_TEST_SUITE_P(
    Configs, ShippedSurveys,
    testing::Values("image_folder.yaml", "quickstart.yaml", "run.yaml", "studies/attitude.yaml",
                    "studies/paper_pool.yaml", "studies/paper_registration.yaml",
                    "studies/paper_registration_pool.yaml", "studies/paper_separation.yaml",
                    "studies/paper_simulated.yaml", "studies/shared_errors_altimeter.yaml",
                    "studies/shared_errors_tilt.yaml", "studies/wrong_loops.yaml"),
    [](const auto& test_case) { return fs::path(test_case.param).stem().string(); });

}  // namespace
}  // namespace fathom
