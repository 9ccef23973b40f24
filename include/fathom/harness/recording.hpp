#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "fathom/configuration/configuration.hpp"
#include "fathom/estimation/estimator.hpp"
#include "fathom/front_end/calibration.hpp"
#include "fathom/front_end/front_end.hpp"
#include "fathom/harness/found_sigma.hpp"
#include "fathom/harness/front_end_pace.hpp"
#include "fathom/harness/survey.hpp"
#include "fathom/measurements/g2o.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// Progress callback: steps done, of how many.
using Progress = std::function<void(std::size_t done, std::size_t of)>;

/// The front end's output for a survey: the measurement log that every estimator is given, and what
/// their evaluation needs.
struct Recording {
  MeasurementLog log;
  std::vector<std::int64_t> keyframe_times_ns;
  std::vector<FramePlace> frames;            ///< empty for a pose graph
  std::vector<std::size_t> keyframe_frames;  ///< likewise
  std::vector<Pose> frame_dead_reckoning;    ///< one per frame, from the start on
  std::vector<Stance> frame_stances;         ///< one per frame, as measured
  /// Of the keyframes, where all of them have it.
  std::optional<std::vector<Pose>> ground_truth;
  /// Of the keyframes, as measured, and the camera that took their pictures; absent for a graph.
  std::vector<Stance> keyframe_stances;
  std::optional<Camera> camera;
  std::vector<StampedPose> frame_ground_truth;  ///< of the frames that have it
  std::optional<FrontEndInMetres> in_metres;    ///< absent for a graph
  std::size_t registrations_tried = 0;
  /// Pairs that were not registered anew, as the cache knew them.
  std::size_t registrations_from_cache = 0;
  /// Of the pairs tried and not found: most matches that agreed in one of them.
  int most_refused_inliers = 0;
  /// Loop candidates beyond what a keyframe may have.
  std::size_t registrations_left_out = 0;
  /// Keyframes, rising, whose loop candidates asked the reference for covariances.
  std::vector<std::size_t> asked_covariances;
  /// By registration of the log, in order; empty where none was added, or it is not known.
  std::vector<bool> is_false_loop;
  /// Likewise, whether a second run is not given it (draw_held_out); empty: there is no second run.
  std::vector<bool> is_held_out;
  /// Standard deviations that the survey's own loops were asked for.
  std::vector<FoundSigma> found_sigmas;
  std::vector<std::string> remarks;  ///< on its pictures: what is masked, which repeat
  cv::Mat mask;                      ///< of every picture, as of PictureUse; empty: nothing
  bool visual_odometry = false;
  std::size_t visual_odometry_failures = 0;
};

/// Runs the front end over the data set once. Loop candidates are selected by
/// `configuration.reference`, which runs along; the log is all that is kept of it.
/// Of a g2o data set: the graph, with vertex ids (stamps_of) as whole seconds, its start known.
/// Registrations that the cache knows are not made again; the recording is the same with a cache
/// and without.
Recording record(const Configuration& configuration, const EstimatorRegistry& registry,
                 const FrontEndProgressCallback& progress = {}, RegistrationCache* cache = nullptr);

/// A survey of a data set, opened once to be recorded again and again: by other estimators, in
/// other trials. May be used from several threads at once.
class Recorder {
 public:
  /// Opens a survey of the data set. The cache must outlive this. Throws InputError.
  explicit Recorder(const Configuration& configuration, RegistrationCache* cache = nullptr,
                    std::size_t survey = 0);

  /// A trial of a configuration whose picture_settings are those of the data set; `noise` is that
  /// of the survey. Loop candidates are selected by the reference; `automatic` is settled by the
  /// frames of this trial. False loops, where the study has them, are added afterwards: the
  /// reference never sees them.
  Recording record(const Configuration& configuration, const CandidateReference& reference,
                   const EstimatorRegistry& registry, const TrialNoise& noise,
                   const FrontEndProgressCallback& progress = {}) const;

  /// What the registrations of consecutive keyframes of a recording, made so, say of the set-up. Of
  /// a pose graph: nothing.
  Calibration calibration_of(const Recording& recording, const Configuration& configuration,
                             const TrialNoise& noise) const;

  const DataSet& data() const { return pictures_ ? pictures_->data() : *graph_data_; }

  /// The pictures; nothing for a pose graph. Their motions may not be those of any trial.
  const FrameSource* pictures() const;

 private:
  std::unique_ptr<const DataSet> graph_data_;
  std::optional<Recording> graph_;
  std::shared_ptr<Pictures> pictures_;
};

/// A pose graph as a recording, read from a file. Where its priors hold it, the start is free, as a
/// batch solve can have it (with_start_of_priors). Times are stamps_of the log.
Recording record_graph(const std::filesystem::path& path, const GraphOptions& options = {});

/// Gives a graph its true poses, from a TUM file with vertex ids as time stamps; where they are too
/// large, with what stands for them (stamps_of) and no other pose. Throws InputError where one is
/// missing.
void attach_ground_truth(Recording& graph, const std::filesystem::path& path);

}  // namespace fathom
