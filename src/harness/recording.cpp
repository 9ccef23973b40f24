#include "fathom/harness/recording.hpp"

#include <algorithm>
#include <cmath>

#include "candidate_guide.hpp"
#include "carried_readings.hpp"
#include "fathom/front_end/repeated_keypoints.hpp"
#include "fathom/harness/false_loops.hpp"
#include "fathom/harness/recording_facts.hpp"
#include "fathom/harness/survey.hpp"
#include "fathom/measurements/adjusted_responses.hpp"
#include "find_sigmas.hpp"
#include "graph_recording.hpp"

namespace fathom {
namespace {

std::vector<Pose> dead_reckoned_poses(const FrameSource& frames, std::size_t count,
                                      const Pose& start) {
  std::vector<Pose> motions;
  for (std::size_t i = 1; i < count; ++i) motions.push_back(frames.info(i).motion->mean);
  return compose_trajectory(start, motions);
}

std::optional<std::vector<Pose>> ground_truth_of(const FrameSource& frames,
                                                 const std::vector<Keyframe>& keyframes) {
  std::vector<Pose> truth;
  for (const Keyframe& keyframe : keyframes) {
    const auto& pose = frames.info(keyframe.frame).ground_truth;
    if (!pose) return std::nullopt;
    truth.push_back(*pose);
  }
  return truth;
}

std::vector<StampedPose> frame_ground_truth_of(const FrameSource& frames, std::size_t count) {
  std::vector<StampedPose> truth;
  for (std::size_t i = 0; i < count; ++i) {
    const FrameInfo& info = frames.info(i);
    if (info.ground_truth) truth.push_back({info.time_ns, *info.ground_truth});
  }
  return truth;
}

// The paper from pictures to measurements. A guide runs along, as the candidates of section 3 are
// picked by a trajectory; the log of measurements is all that is kept of it.
MeasurementLog log_of(FrontEnd& front_end, CandidateGuide& guide, CarriedReadings& readings,
                      const std::function<void()>& say_progress) {
  MeasurementLog log(readings.start());
  say_progress();
  // Section 2: every so many frames a keyframe, with the dead reckoning since the last one.
  while (const auto keyframe = front_end.next_keyframe()) {
    // Section 3, augmentation: the state grows by the motion to the new keyframe.
    guide.add_keyframe(*keyframe);
    if (keyframe->step) log.add_keyframe(*keyframe->step);
    // What compass and fixes say of it narrows where its candidates can be.
    const std::vector<AbsolutePose> absolute = readings.next();
    for (const AbsolutePose& measurement : absolute) log.add_absolute(measurement);
    if (!absolute.empty()) guide.update({.registrations = {}, .absolute = absolute});
    if (keyframe->step) {
      // Section 3, data association: the keyframes that the estimate has near; each pair is
      // registered by features, their matches and RANSAC (section 2, figures 1 to 3, equations 1
      // to 3).
      const auto found = front_end.register_newest(guide.trajectory());
      for (const RelativePose& registration : found) log.add_registration(registration);
      // Section 3, update: all registrations of the keyframe stacked, and iterated.
      if (!found.empty()) guide.update({.registrations = found});
    }
    say_progress();
  }
  say_progress();
  return log;
}

void take_keyframes(Recording& recording, const FrameSource& source, const FrontEnd& front_end) {
  for (const Keyframe& keyframe : front_end.keyframes()) {
    recording.keyframe_times_ns.push_back(keyframe.time_ns);
    recording.keyframe_frames.push_back(keyframe.frame);
    recording.keyframe_stances.push_back(source.info(keyframe.frame).stance());
  }
  recording.ground_truth = ground_truth_of(source, front_end.keyframes());
  recording.in_metres = front_end.in_metres();
  recording.registrations_tried = front_end.registrations_tried();
  recording.most_refused_inliers = front_end.most_refused_inliers();
  recording.registrations_left_out = front_end.registrations_left_out();
  recording.asked_covariances = front_end.asked_covariances();
}

void take_frames(Recording& recording, const FrameSource& source, const FrontEnd& front_end) {
  recording.camera = source.camera();
  recording.frames = front_end.frames();
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    recording.frame_stances.push_back(source.info(i).stance());
  }
  recording.frame_dead_reckoning =
      dead_reckoned_poses(source, recording.frames.size(), recording.log.origin());
  recording.frame_ground_truth = frame_ground_truth_of(source, recording.frames.size());
}

std::unique_ptr<CandidateGuide> guide_of(const Survey& survey, const Configuration& configuration,
                                         const CandidateReference& reference,
                                         const EstimatorRegistry& registry,
                                         const StartPose& start) {
  try {
    return make_guide(reference, registry, survey.measured(), configuration.front_end.keyframes,
                      start);
  } catch (const InputError& error) {
    throw at_origin(configuration, error);
  }
}

Recording record_with(const EstimatedSigmas& sigmas, Survey& survey,
                      const Configuration& configuration, const CandidateReference& reference,
                      const EstimatorRegistry& registry, const FrontEndProgressCallback& progress) {
  const FrameSource& source = survey.frames();
  FrontEnd front_end(source, survey.registrar(), configuration.front_end, sigmas);
  CarriedReadings readings(survey, configuration);
  const auto guide = guide_of(survey, configuration, reference, registry, readings.start());
  std::optional<FrontEndPace> pace;
  if (progress) pace.emplace(source, survey.registrar(), configuration.front_end);
  Recording recording;
  recording.log = log_of(front_end, *guide, readings, [&] {
    if (progress) progress(pace->at(front_end));
  });
  if (front_end.keyframes().size() < 2) {
    throw at_origin(configuration,
                    single_keyframe(configuration.front_end.keyframes, source.size()));
  }
  take_keyframes(recording, source, front_end);
  take_frames(recording, source, front_end);
  recording.remarks = survey.pictures().remarks();
  recording.mask = survey.pictures().mask();
  recording.registrations_from_cache = survey.registrar().from_cache();
  recording.visual_odometry = survey.uses_visual_odometry();
  recording.visual_odometry_failures = survey.visual_odometry_failures();
  return recording;
}

bool have_intervals(const std::vector<FoundSigma>& found) {
  return std::ranges::none_of(found, [](const FoundSigma& one) { return std::isnan(one.low); });
}

// By one solver, whatever others there are: the log must not depend on them.
void adjust_responses(Recording& recording, const EstimatorRegistry& registry) {
  constexpr const char* kSolver = "sparse_gauss_newton";
  if (!recording.log.tells_shared_errors()) return;
  const std::vector<EstimatorEntry>& entries = registry.entries();
  const auto entry = std::ranges::find(entries, kSolver, &EstimatorEntry::name);
  if (entry == entries.end()) return;
  EstimatorRegistry solver;
  solver.add(*entry);
  const auto optimum = batch_optimum(recording.log, solver, {}, RegistrationErrors::shared);
  if (!optimum) return;
  std::vector<double> altitudes_m;
  for (const Stance& stance : recording.keyframe_stances) altitudes_m.push_back(stance.altitude_m);
  recording.log = with_adjusted_responses(recording.log, optimum->poses, altitudes_m);
}

// Once with standard deviations as assumed, again as they are found. Pairs are registered once.
Recording record_survey(Survey& survey, const Configuration& configuration,
                        const CandidateReference& reference, const EstimatorRegistry& registry,
                        const FrontEndProgressCallback& progress) {
  Recording recording = record_with({}, survey, configuration, reference, registry, progress);
  const CovarianceOptions& stated = configuration.front_end.registration.covariance;
  const auto find = [&](bool with_intervals) {
    return find_sigmas(recording, survey.measured(), stated, registry, with_intervals);
  };
  const auto record_again = [&](const EstimatedSigmas& sigmas) {
    survey.tell(sigmas);
    recording = record_with(sigmas, survey, configuration, reference, registry, {});
  };
  std::vector<FoundSigma> found = find(false);
  EstimatedSigmas sigmas = sigmas_of(found);
  if (are_assumed_too_small(sigmas, stated)) {
    sigmas.own_factor.reset();
    record_again(sigmas);
    sigmas = sigmas_of(found = find(true));
  } else if (!have_intervals(found)) {
    // They would be, but are refused.
    sigmas = sigmas_of(found = find(true));
  }
  if (!sigmas.is_empty()) record_again(sigmas);
  adjust_responses(recording, registry);
  if (configuration.front_end.repeated_keypoints == RepeatedKeypoints::once) {
    recording.log = count_keypoints_once(
        recording.log,
        repeats_of_keypoints(recording.log, *recording.camera, recording.keyframe_stances));
  }
  recording.found_sigmas = std::move(found);
  return recording;
}

std::optional<DrawnGraph> draw_graph(const DataSet& data, const Configuration& configuration,
                                     const TrialNoise& noise) {
  try {
    return std::move(data.trial(configuration.dataset.values, noise).graph);
  } catch (const InputError& error) {
    throw at_origin(configuration, error);
  }
}

}  // namespace

Recorder::Recorder(const Configuration& configuration, RegistrationCache* cache,
                   std::size_t survey) {
  if (!find_data_set(configuration.dataset.type).is_graph) {
    pictures_ = std::make_shared<Pictures>(configuration, cache, survey);
    return;
  }
  graph_data_ = open_data_set(configuration, survey);
  const auto files = graph_data_->files();
  const std::string name = files.empty() ? "dataset" : files.front().string();
  graph_ = graph_recording(with_start_of_priors(*graph_data_->graph(), name), name);
}

Recording Recorder::record(const Configuration& configuration, const CandidateReference& reference,
                           const EstimatorRegistry& registry, const TrialNoise& noise,
                           const FrontEndProgressCallback& progress) const {
  Recording recording;
  if (graph_) {
    auto drawn = draw_graph(*graph_data_, configuration, noise);
    recording = drawn ? drawn_recording(std::move(*drawn)) : *graph_;
  } else {
    Survey survey(pictures_, configuration, noise);
    recording = record_survey(survey, configuration, reference, registry, progress);
  }
  const SpoilOptions& false_loops = configuration.study.false_loops;
  if (false_loops.share > 0.0) {
    spoil_recording(recording, false_loops, registry, noise.seed, noise.trial);
  }
  return recording;
}

const FrameSource* Recorder::pictures() const {
  return pictures_ ? &pictures_->source() : nullptr;
}

Recording record(const Configuration& configuration, const EstimatorRegistry& registry,
                 const FrontEndProgressCallback& progress, RegistrationCache* cache) {
  const TrialNoise noise{static_cast<std::uint64_t>(configuration.seed), 0};
  return Recorder(configuration, cache)
      .record(configuration, configuration.reference, registry, noise, progress);
}

}  // namespace fathom
