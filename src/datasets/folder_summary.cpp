#include "fathom/datasets/folder_summary.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "fathom/core/environment_error.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/median.hpp"
#include "fathom/core/text.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {
namespace {

std::string number(double value, int digits = 4) {
  return short_number(value, digits);
}

std::string percent(double share) {
  return number(100.0 * share, 3) + " %";
}

std::string range(double low, double high) {
  return number(low) + " to " + number(high);
}

// "7 (frames 3, 9, 12, ...)": enough to find them.
std::string listed(const std::vector<std::size_t>& frames) {
  constexpr std::size_t kShown = 5;
  std::string text = std::to_string(frames.size()) + " (frame";
  text += frames.size() > 1 ? "s " : " ";
  for (std::size_t i = 0; i < std::min(frames.size(), kShown); ++i) {
    text += (i > 0 ? ", " : "") + std::to_string(frames[i]);
  }
  return text + (frames.size() > kShown ? ", ...)" : ")");
}

void warn(FolderSummary& summary, const std::vector<std::size_t>& frames, const std::string& what) {
  if (!frames.empty()) summary.warnings.push_back(what + ": " + listed(frames));
}

void sum_up_camera(const FrameSource& source, FolderSummary& summary) {
  const CameraModel& model = source.camera().model();
  const bool is_named = model.distortion_model != DistortionModel::radial_tangential;
  const std::string distortion = !model.has_distortion() ? "no"
                                 : is_named              ? entry_of(model.distortion_model).name
                                                         : "with";
  summary.facts.push_back(
      fmt::format("camera: {} x {} pixels, f {}, {}, centre {}, {}, {} distortion", model.width,
                  model.height, number(model.fx, 6), number(model.fy, 6), number(model.cx, 6),
                  number(model.cy, 6), distortion));
  summary.facts.push_back(fmt::format(
      "mounting: x {} m, y {} m, yaw {} rad{}", number(model.mount_x_m), number(model.mount_y_m),
      number(model.mount_yaw_rad), model.is_mirrored ? "; mirrored" : ""));
}

void sum_up_time(const FrameSource& source, FolderSummary& summary) {
  const std::int64_t start_ns = source.info(0).time_ns;
  const std::int64_t end_ns = source.info(source.size() - 1).time_ns;
  summary.facts.push_back(fmt::format("frames: {} in {} s", source.size(),
                                      number(static_cast<double>(end_ns - start_ns) * 1e-9, 6)));
  if (source.size() < 2) return;
  const auto interval = [&](std::size_t i) {
    return static_cast<double>(source.info(i).time_ns - source.info(i - 1).time_ns);
  };
  std::vector<double> intervals;
  for (std::size_t i = 1; i < source.size(); ++i) intervals.push_back(interval(i));
  constexpr double kGap = 3.0;
  const double usual = upper_median(intervals);
  std::vector<std::size_t> gaps;
  for (std::size_t i = 1; i < source.size(); ++i) {
    if (interval(i) > kGap * usual) gaps.push_back(i);
  }
  warn(summary, gaps, "time gaps, more than three times the median interval");
}

void sum_up_altitude(const FrameSource& source, FolderSummary& summary) {
  double low_m = source.info(0).altitude_m;
  double high_m = low_m;
  double least_sigma_m = source.info(0).altitude_sigma_m;
  double most_sigma_m = least_sigma_m;
  std::vector<std::size_t> jumps;
  constexpr double kJump = 1.5;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const double altitude_m = source.info(i).altitude_m;
    least_sigma_m = std::min(least_sigma_m, source.info(i).altitude_sigma_m);
    most_sigma_m = std::max(most_sigma_m, source.info(i).altitude_sigma_m);
    low_m = std::min(low_m, altitude_m);
    high_m = std::max(high_m, altitude_m);
    const double last_m = source.info(i > 0 ? i - 1 : 0).altitude_m;
    if (std::max(altitude_m / last_m, last_m / altitude_m) > kJump) jumps.push_back(i);
  }
  const CameraModel& model = source.camera().model();
  const double focal = std::sqrt(model.fx * model.fy);
  summary.facts.push_back(
      fmt::format("altitude: {} m, {} mm per pixel, sigma {}", range(low_m, high_m),
                  range(1e3 * low_m / focal, 1e3 * high_m / focal),
                  !(most_sigma_m > 0.0)           ? "not stated"
                  : least_sigma_m == most_sigma_m ? number(most_sigma_m) + " m"
                                                  : range(least_sigma_m, most_sigma_m) + " m"));
  warn(summary, jumps, "altitude changes by more than half from the frame before");
}

// In degrees, so that radians that were degrees stand out.
void sum_up_attitude(const FrameSource& source, FolderSummary& summary) {
  if (!source.has_attitude()) return;
  constexpr double kDegree = std::numbers::pi / 180.0;
  std::vector<double> rolls, pitches, sigmas;
  std::vector<std::size_t> steep;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const MeasuredTilt& measured = source.info(i).tilt.value();
    rolls.push_back(measured.tilt.roll_rad / kDegree);
    pitches.push_back(measured.tilt.pitch_rad / kDegree);
    sigmas.push_back(measured.sigma_rad / kDegree);
    constexpr double kSteep = 15.0;
    if (std::max(std::abs(rolls.back()), std::abs(pitches.back())) > kSteep) steep.push_back(i);
  }
  const auto span = [](const std::vector<double>& values) {
    return range(std::ranges::min(values), std::ranges::max(values));
  };
  summary.facts.push_back("attitude: roll " + span(rolls) + " degrees, pitch " + span(pitches) +
                          " degrees, median sigma " + number(upper_median(sigmas)) + " degrees");
  warn(summary, steep, "roll or pitch of more than 15 degrees; is attitude0 in radians?");
}

// How far dead reckoning has left the truth at the end, both from the first frame on.
void compare_with_truth(const FrameSource& source, const Pose& reckoned, double path_m,
                        FolderSummary& summary) {
  const Pose truth =
      between(*source.info(0).ground_truth, *source.info(source.size() - 1).ground_truth);
  const double drift_m = (reckoned.position() - truth.position()).norm();
  summary.facts.push_back(fmt::format("odometry drift at the end: {} m, {} of the path",
                                      number(drift_m), percent(drift_m / path_m)));
  constexpr double kDrift = 0.2;
  if (drift_m > kDrift * path_m) {
    summary.warnings.emplace_back(
        "odometry ends further from ground truth than a fifth of the "
        "path; do both use x forward, y to port and radians?");
  }
}

void sum_up_odometry(const FrameSource& source, FolderSummary& summary) {
  if (!source.has_odometry()) {
    summary.facts.emplace_back("odometry: none");
    return;
  }
  if (source.size() < 2) return;
  Pose pose;
  double path_m = 0.0;
  std::vector<double> overlaps;
  std::vector<std::size_t> apart;
  for (std::size_t i = 1; i < source.size(); ++i) {
    const FrameInfo& now = source.info(i);
    path_m += now.motion->mean.position().norm();
    pose = compose(pose, now.motion->mean);
    overlaps.push_back(footprint_overlap(source.camera(), source.info(i - 1).stance(), now.stance(),
                                         now.motion->mean));
    if (overlaps.back() <= 0.0) apart.push_back(i);
  }
  summary.facts.push_back("odometry: path of " + number(path_m) + " m");
  summary.facts.push_back("overlap of consecutive pictures: median " +
                          percent(upper_median(overlaps)) + ", least " +
                          percent(*std::ranges::min_element(overlaps)));
  warn(summary, apart, "by dead reckoning no overlap with the picture before");
  if (source.has_ground_truth() && path_m > 0.0) compare_with_truth(source, pose, path_m, summary);
}

void sum_up_ground_truth(const FrameSource& source, FolderSummary& summary) {
  std::size_t known = 0;
  for (std::size_t i = 0; i < source.size(); ++i) known += source.info(i).ground_truth ? 1 : 0;
  summary.facts.push_back(
      "ground truth: " +
      (known == 0 ? "none" : fmt::format("{} of {} frames", known, source.size())));
  if (known > 0 && known < source.size()) {
    summary.warnings.emplace_back(
        "ground truth does not cover every frame: accuracy is computed from it "
        "only where every keyframe has it");
  }
}

void look_at_pictures(const FrameSource& source, FolderSummary& summary) {
  constexpr double kFlat = 3.0;
  std::vector<std::size_t> flat;
  for (std::size_t i = 0; i < source.size(); ++i) {
    try {
      cv::Scalar mean;
      cv::Scalar deviation;
      cv::meanStdDev(source.image(i), mean, deviation);
      if (deviation[0] < kFlat) flat.push_back(i);
    } catch (const EnvironmentError&) {
      throw;  // of no picture
    } catch (const InputError& error) {
      summary.faults.emplace_back(error.what());
    }
  }
  warn(summary, flat, "pictures with hardly any contrast");
}

}  // namespace

FolderSummary summarise_frames(const FrameSource& source) {
  FolderSummary summary;
  if (source.size() == 0) {
    summary.warnings.emplace_back("there are no frames");
    return summary;
  }
  sum_up_time(source, summary);
  sum_up_camera(source, summary);
  sum_up_altitude(source, summary);
  sum_up_attitude(source, summary);
  sum_up_odometry(source, summary);
  sum_up_ground_truth(source, summary);
  look_at_pictures(source, summary);
  return summary;
}

}  // namespace fathom
