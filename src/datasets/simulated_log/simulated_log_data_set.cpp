// The entry `simulated_log`: see simulated_log.hpp.

#include <fmt/format.h>
#include <memory>

#include "fathom/core/input_error.hpp"
#include "fathom/datasets/data_set.hpp"
#include "simulated_log.hpp"

namespace fathom {
namespace {

constexpr const char* kDataSetPrefix = "dataset.";

FlownKeyframes fly(const SimulatedLogOptions& options) {
  FlownKeyframes keyframes;
  keyframes.frames = fly_mission(options.mission, std::string(kDataSetPrefix) + "mission.");
  keyframes.separation = static_cast<std::size_t>(options.separation_frames);
  if (keyframes.size() < 2) {
    throw InputError(
        fmt::format("{}separation_frames: leads beyond the last frame, so there is a single "
                    "keyframe; expected at most {}",
                    kDataSetPrefix, keyframes.frames.size() - 1));
  }
  return keyframes;
}

class SimulatedLogDataSet : public DataSet {
 public:
  SimulatedLogDataSet(const SimulatedLogOptions& options, std::uint64_t seed)
      : keyframes_(fly(options)), log_(draw_log(keyframes_, options, seed, 0)) {
    for (std::size_t k = 0; k < keyframes_.size(); ++k) truth_.push_back(keyframes_[k]);
  }

  const MeasurementLog* graph() const override { return &log_; }

  Trial trial(const DataSetValues& values, const TrialNoise& noise) const override {
    const auto options = options_of<SimulatedLogOptions>(values);
    Trial trial;
    trial.graph = DrawnGraph{draw_log(keyframes_, options, noise.seed, noise.trial), truth_};
    return trial;
  }

 private:
  FlownKeyframes keyframes_;
  std::vector<StampedPose> truth_;
  MeasurementLog log_;
};

}  // namespace

DataSetEntry simulated_log_data_set() {
  DataSetEntry entry = make_data_set<SimulatedLogOptions>(
      "simulated_log", "the measurements of a mission, drawn without pictures",
      [](const SimulatedLogOptions& options, std::uint64_t seed) {
        return std::make_unique<SimulatedLogDataSet>(options, seed);
      });
  entry.is_graph = true;
  return entry;
}

}  // namespace fathom
