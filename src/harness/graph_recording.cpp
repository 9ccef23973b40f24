#include "graph_recording.hpp"

#include <cmath>

#include "fathom/measurements/graph_numbers.hpp"

namespace fathom {
namespace {

void require_finite(const MeasurementLog& log, const std::string& file) {
  const auto require = [&](const std::vector<Pose>& poses, const std::string& name) {
    if (std::isfinite(chi2(log, poses))) return;
    throw InputError(file, "F is not finite at " + name +
                               ": it has numbers beyond what can be computed with; expected "
                               "metres, radians and their information");
  };
  require(log.odometry(), "dead reckoning");
  if (log.guess) require(*log.guess, "its vertices");
}

}  // namespace

Recording graph_recording(MeasurementLog log, const std::string& file) {
  Recording recording;
  constexpr std::int64_t kSecond = 1'000'000'000;
  for (const std::int64_t stamp : stamps_of(log)) {
    recording.keyframe_times_ns.push_back(stamp * kSecond);
  }
  require_finite(log, file);
  recording.log = std::move(log);
  return recording;
}

Recording drawn_recording(DrawnGraph drawn) {
  Recording recording;
  require_finite(drawn.log, "dataset");
  recording.ground_truth.emplace();
  for (const StampedPose& pose : drawn.ground_truth) {
    recording.keyframe_times_ns.push_back(pose.time_ns);
    recording.ground_truth->push_back(pose.pose);
  }
  recording.log = std::move(drawn.log);
  return recording;
}

Recording record_graph(const std::filesystem::path& path, const GraphOptions& options) {
  return graph_recording(read_g2o(path, options), path.string());
}

}  // namespace fathom
