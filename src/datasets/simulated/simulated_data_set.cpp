// The entry `simulated`: see simulated_survey.hpp.

#include <memory>
#include <utility>

#include "fathom/datasets/data_set.hpp"
#include "fathom/datasets/simulated_sensors.hpp"
#include "simulated_survey.hpp"

namespace fathom {
namespace {

class SimulatedDataSet : public DataSet {
 public:
  SimulatedDataSet(const SimulatedSurveyOptions& options, std::uint64_t seed)
      : survey_(options, seed), picture_(options.world.picture) {}

  const FrameSource* frames() const override { return &survey_; }

  Trial trial(const DataSetValues& values, const TrialNoise& noise) const override {
    const auto options = options_of<SimulatedSurveyOptions>(values);
    Trial trial;
    auto survey = std::make_unique<SimulatedSurvey>(
        survey_.remeasured(options.odometry, options.sensors, noise.seed, noise.trial));
    trial.absolute = survey->readings();
    trial.start = draw_start(options.start, noise.seed, noise.trial);
    trial.frames = std::move(survey);
    if (!trial.frames->has_odometry()) {
      trial.added_noise = options.odometry.noise_covariance("dataset.odometry.");
    }
    return trial;
  }

  std::vector<std::filesystem::path> files() const override {
    if (picture_.empty()) return {};
    return {picture_};
  }

 private:
  SimulatedSurvey survey_;
  std::filesystem::path picture_;
};

}  // namespace

DataSetEntry simulated_data_set() {
  DataSetEntry entry = make_data_set<SimulatedSurveyOptions>(
      "simulated", "a survey flown over a picture or a procedural floor",
      [](const SimulatedSurveyOptions& options, std::uint64_t seed) {
        return std::make_unique<SimulatedDataSet>(options, seed);
      });
  entry.makes_pictures = true;
  return entry;
}

}  // namespace fathom
