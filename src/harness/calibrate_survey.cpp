#include "fathom/harness/calibrate_survey.hpp"

#include <algorithm>
#include <utility>

namespace fathom {
namespace {

using FramePair = std::pair<std::size_t, std::size_t>;

constexpr std::size_t kMostPairs = 250;
constexpr std::size_t kStretch = 25;

// Stretches of the pairs, evenly spread, and in them all.
std::vector<FramePair> sampled(const std::vector<FramePair>& pairs) {
  if (pairs.size() <= kMostPairs) return pairs;
  constexpr std::size_t kStretches = kMostPairs / kStretch;
  std::vector<FramePair> some;
  for (std::size_t s = 0; s < kStretches; ++s) {
    const std::size_t first = s * (pairs.size() - kStretch) / (kStretches - 1);
    for (std::size_t i = first; i < first + kStretch; ++i) some.push_back(pairs[i]);
  }
  return some;
}

std::vector<FramePair> consecutive_keyframes(const FrameSource& frames,
                                             const KeyframeOptions& options) {
  KeyframeSchedule schedule(frames, options);
  std::vector<FramePair> pairs;
  std::size_t from = schedule.frame(0).value_or(0);
  for (std::size_t k = 1; const auto to = schedule.frame(k); ++k) {
    if (!frames.info(*to).is_hole) pairs.emplace_back(from, *to);
    from = *to;
  }
  return pairs;
}

std::vector<FramePair> consecutive_frames(const FrameSource& frames) {
  std::vector<FramePair> pairs;
  for (std::size_t i = 1; i < frames.size(); ++i) pairs.emplace_back(i - 1, i);
  return pairs;
}

class Registering {
 public:
  Registering(Survey& survey, const Progress& progress) : survey_(survey), progress_(progress) {}

  std::vector<SeenMotion> of(const std::vector<FramePair>& pairs, SurveyCalibration& counts) {
    const FrameSource& frames = survey_.measured();
    const auto measured = [&frames](std::size_t i) { return MeasuredFrame::of(frames, i); };
    PairRegistrar& registrar = survey_.registrar();
    std::vector<SeenMotion> motions;
    chain_ = {};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      for (std::size_t j = i + 1; j < std::min(pairs.size(), i + 1 + PairRegistrar::look_ahead());
           ++j) {
        registrar.announce(measured(pairs[j].first), measured(pairs[j].second));
      }
      const auto [from, to] = pairs[i];
      const PairRegistration found = registrar.of(measured(from), measured(to));
      ++counts.tried;
      if (found.found) {
        motions.push_back(seen_motion(frames, from, to, {found.motion, found.covariance}));
        append(frames.info(from).time_ns, frames.info(to).time_ns, found.motion);
      }
      if (progress_) progress_(i + 1, pairs.size());
    }
    counts.found += motions.size();
    return motions;
  }

  /// What was registered last as dead reckoning, with holes where it does not go on.
  RecordedOdometry chain() const { return chain_; }

 private:
  void append(std::int64_t from_ns, std::int64_t to_ns, const Pose& motion) {
    std::vector<ReckonedRow>& rows = chain_.rows;
    if (rows.empty() || rows.back().time_ns != from_ns) {
      const ReckonedRow last = rows.empty() ? ReckonedRow{} : rows.back();
      rows.push_back({from_ns, last.x_m, last.y_m, last.heading_rad, !rows.empty()});
    }
    const ReckonedRow last = rows.back();
    const Pose next = compose({last.x_m, last.y_m, last.heading_rad}, motion);
    rows.push_back({to_ns, next.x, next.y, last.heading_rad + motion.theta, false});
  }

  Survey& survey_;
  const Progress& progress_;
  RecordedOdometry chain_;
};

// Where frames have no dead reckoning of their own it is that of the recording.
RecordedOdometry reckoned(const Recording& recording) {
  RecordedOdometry odometry;
  double heading_rad = 0.0;
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    const Pose& pose = recording.frame_dead_reckoning[i];
    heading_rad += wrap_angle(pose.theta - heading_rad);
    odometry.rows.push_back({recording.frames[i].time_ns, pose.x, pose.y, heading_rad, false});
  }
  return odometry;
}

std::vector<SeenMotion> motions_of(const Recording& recording, const FrameSource& frames) {
  std::vector<SeenMotion> motions;
  const auto add = [&](const RelativePose& z) {
    motions.push_back(seen_motion(frames, recording.keyframe_frames[z.from],
                                  recording.keyframe_frames[z.to],
                                  {z.motion, z.alone().covariance()}));
  };
  for (std::size_t k = 1; k < recording.log.size(); ++k) {
    const KeyframeMeasurements& arrival = recording.log.arrival(k);
    if (recording.visual_odometry) {
      add(arrival.step);
      continue;
    }
    for (const RelativePose& z : arrival.registrations) {
      if (z.from + 1 == z.to) add(z);
    }
  }
  if (motions.size() <= kMostPairs) return motions;
  std::vector<SeenMotion> some;
  std::vector<FramePair> indices;
  for (std::size_t i = 0; i < motions.size(); ++i) indices.emplace_back(i, i);
  for (const FramePair& pair : sampled(indices)) some.push_back(motions[pair.first]);
  return some;
}

}  // namespace

SurveyCalibration calibrate_survey(Survey& survey, const FrontEndOptions& options,
                                   const Progress& progress) {
  const FrameSource& frames = survey.measured();
  SurveyCalibration done;
  CalibrationInput input = calibration_input(frames, survey.readings());
  Registering registering(survey, progress);
  if (frames.has_odometry()) {
    const auto pairs = sampled(consecutive_keyframes(frames, options.keyframes));
    input.motions = registering.of(pairs, done);
  }
  constexpr std::size_t kFewest = 20;
  if (2 * done.found < done.tried || done.found < kFewest) {
    const auto pairs = sampled(consecutive_frames(frames));
    auto motions = registering.of(pairs, done);
    if (motions.size() > input.motions.size()) input.motions = std::move(motions);
  }
  if (!frames.has_odometry()) {
    input.odometry = registering.chain();
    input.is_visual_odometry = true;
  }
  done.calibration = calibrate(input);
  return done;
}

Calibration Recorder::calibration_of(const Recording& recording, const Configuration& configuration,
                                     const TrialNoise& noise) const {
  if (!pictures_) return {};
  const Survey survey(pictures_, configuration, noise);
  const FrameSource& frames = survey.measured();
  CalibrationInput input = calibration_input(frames, survey.readings());
  if (input.odometry.rows.empty()) {
    input.odometry = reckoned(recording);
    input.is_visual_odometry = true;
  }
  input.motions = motions_of(recording, frames);
  return calibrate(input);
}

}  // namespace fathom
