#include "fathom/harness/ground_truth.hpp"

#include <map>
#include <memory>
#include <string>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/geometry/trajectory_file.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/survey.hpp"
#include "fathom/measurements/graph_numbers.hpp"

namespace fathom {
namespace {

using Kind = CandidateReference::Kind;

// What makes its pictures knows where they are; other data sets are looked at, each once.
class TrueFrames {
 public:
  std::optional<std::size_t> missing(const Configuration& cell) {
    if (find_data_set(cell.dataset.type).makes_pictures) return std::nullopt;
    auto& data = opened_[data_settings(cell)];
    if (!data) data = open_data_set(cell);
    return keyframe_without_truth(*data->frames(), cell.front_end.keyframes);
  }

 private:
  std::map<std::string, std::unique_ptr<const DataSet>> opened_;
};

}  // namespace

std::optional<std::size_t> keyframe_without_truth(const FrameSource& frames,
                                                  const KeyframeOptions& keyframes) {
  const auto separation = static_cast<std::size_t>(keyframes.least_separation());
  for (std::size_t frame = 0; frame < frames.size(); frame += separation) {
    if (!frames.info(frame).ground_truth) return frame;
  }
  return std::nullopt;
}

InputError no_ground_truth(std::size_t frame) {
  return InputError("association.reference: ground_truth, but the data set has none at frame " +
                    std::to_string(frame) +
                    "; expected an estimator, such as {type: incremental_smoother}");
}

void settle_reference(Study& study, const EstimatorRegistry& registry) {
  TrueFrames frames;
  bool all_have_truth = true;
  for (const Configuration& cell : study.cells) {
    const Kind kind = cell.reference.kind;
    if (!selects_by_reference(cell) || kind == Kind::estimate) continue;
    const auto missing = frames.missing(cell);
    if (missing && kind == Kind::ground_truth) throw at_origin(cell, no_ground_truth(*missing));
    if (missing) all_have_truth = false;
  }
  settle_references(study, all_have_truth ? Kind::ground_truth : Kind::estimate, registry);
}

namespace {

// Where stamps are places in the order of the ids, a file that goes by other numbers must not fit
// by chance.
void require_places(const std::vector<StampedPose>& truth, const MeasurementLog& log,
                    const std::string& file) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const auto last = static_cast<std::int64_t>(log.size() - 1);
  if (truth.size() == log.size() && truth.front().time_ns == 0 &&
      truth.back().time_ns == last * kSecond) {
    return;
  }
  throw InputError(file, "expected a pose for each of the time stamps 0 to " +
                             std::to_string(last) + ", which stand for the ids up to " +
                             std::to_string(log.ids.back()) +
                             " in their order, and no other, got " + counted(truth.size(), "pose"));
}

}  // namespace

void attach_ground_truth(Recording& graph, const std::filesystem::path& path) {
  const std::vector<StampedPose> truth = read_tum(path);
  if (has_large_ids(graph.log)) require_places(truth, graph.log, path.string());
  graph.ground_truth.emplace();
  std::size_t next = 0;
  for (const std::int64_t time_ns : graph.keyframe_times_ns) {
    while (next < truth.size() && truth[next].time_ns < time_ns) ++next;
    if (next == truth.size() || truth[next].time_ns != time_ns) {
      throw InputError(path.string(),
                       "has no pose for vertex " + std::to_string(time_ns / 1'000'000'000));
    }
    graph.ground_truth->push_back(truth[next].pose);
  }
}

}  // namespace fathom
