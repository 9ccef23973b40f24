// fathom evaluate: a trajectory against a reference.

#include <cmath>
#include <fmt/format.h>
#include <memory>

#include "apps/command.hpp"
#include "apps/output.hpp"
#include "apps/trajectories.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/evaluation/association.hpp"
#include "fathom/evaluation/spatial_accuracy.hpp"
#include "fathom/report/evaluation_text.hpp"
#include "fathom/report/table.hpp"

namespace fathom {
namespace {

struct EvaluateFlags {
  std::string estimate;
  std::string reference;
  std::string alignment = "origin";
  double max_difference_s = 0.01;
  double time_offset_s = 0.0;
  TrajectoryFlags of_estimate;
  TrajectoryFlags of_reference;
  std::string plane;
  std::string times;
  std::vector<std::size_t> steps{1};
  std::vector<double> distances_m;
};

std::int64_t nanoseconds(double seconds) {
  return static_cast<std::int64_t>(std::llround(seconds * 1e9));
}

void shift_times(SpatialTrajectory& trajectory, double seconds) {
  for (StampedSpatialPose& stamped : trajectory.poses) {
    if (__builtin_add_overflow(stamped.time_ns, nanoseconds(seconds), &stamped.time_ns)) {
      throw InputError("--time-offset: " + short_number(seconds) + " s leads beyond all times");
    }
  }
}

// KITTI poses have no times of their own: without any on either side they are paired by index.
bool are_paired_by_index(const EvaluateFlags& flags, const SpatialTrajectory& estimate,
                         const SpatialTrajectory& reference) {
  if (estimate.has_times && reference.has_times) return false;
  if (estimate.has_times != reference.has_times) {
    throw InputError(estimate.has_times ? flags.reference : flags.estimate,
                     "KITTI poses have no times, and those of " +
                         (estimate.has_times ? flags.estimate : flags.reference) +
                         " have: --times FILE names a file with a time per pose, in seconds");
  }
  if (flags.time_offset_s != 0.0) {
    throw InputError("--time-offset: neither trajectory has times; they are paired by index");
  }
  if (estimate.poses.size() != reference.poses.size()) {
    throw InputError(
        flags.estimate,
        fmt::format(
            "has {} poses, {} {}: without times they are paired by index, and must be as many",
            estimate.poses.size(), flags.reference, reference.poses.size()));
  }
  return true;
}

// The stamps alone, in the type that association takes.
std::vector<StampedPose> stamps_of(const SpatialTrajectory& trajectory) {
  std::vector<StampedPose> stamps;
  for (const StampedSpatialPose& stamped : trajectory.poses)
    stamps.push_back({stamped.time_ns, {}});
  return stamps;
}

[[noreturn]] void refuse_no_pair(const EvaluateFlags& flags, const SpatialTrajectory& estimate,
                                 const SpatialTrajectory& reference) {
  std::string what = fmt::format("no pose is within {} s of one of {}",
                                 format_number(flags.max_difference_s, 3), flags.reference);
  if (estimate.poses.empty() || reference.poses.empty()) {
    const bool neither = estimate.poses.empty() && reference.poses.empty();
    what += neither                  ? "; both hold no pose"
            : estimate.poses.empty() ? "; it holds no pose"
                                     : ", which holds none";
    throw InputError(flags.estimate, what);
  }
  // In 64 bits: doubles of Unix times are good to 0.1 microseconds.
  const auto apart_ns = static_cast<long double>(reference.poses.front().time_ns) -
                        static_cast<long double>(estimate.poses.front().time_ns);
  const double offset_s = flags.time_offset_s + static_cast<double>(apart_ns / 1e9L);
  throw InputError(
      flags.estimate,
      fmt::format("{}: it is from {}, the reference from {}; --time-offset {} lets both begin "
                  "together, and --max-difference may be larger",
                  what, span_text(estimate), span_text(reference), number_text(offset_s)));
}

struct Paired {
  std::vector<StampedSpatialPose> estimate;
  std::vector<StampedSpatialPose> reference;
  std::vector<std::size_t> indices;  ///< in the estimate
};

Paired paired(const EvaluateFlags& flags, const SpatialTrajectory& estimate,
              const SpatialTrajectory& reference) {
  const auto pairs = associate(stamps_of(estimate), stamps_of(reference), flags.max_difference_s);
  if (pairs.empty()) refuse_no_pair(flags, estimate, reference);
  Paired result;
  for (const auto& [e, r] : pairs) {
    result.estimate.push_back(estimate.poses[e]);
    result.reference.push_back(reference.poses[r]);
    result.indices.push_back(e);
  }
  return result;
}

Plane plane_of(const TrajectoryFlags& own, const std::string& of_both, const std::string& flag,
               TrajectoryFormat format) {
  if (!own.plane.empty()) return named(flag, own.plane, plane_names());
  return of_both.empty() ? usual_plane(format) : named("--plane", of_both, plane_names());
}

void evaluate_files(EvaluateFlags flags, Context& context) {
  const auto alignment = named("--align, --alignment", flags.alignment, spatial_alignment_names());
  const auto read = [&](TrajectoryFlags own, const std::string& path, const std::string& flag) {
    // Times are of KITTI poses: another trajectory beside them has its own.
    SpatialTrajectory trajectory = own.read(path, flag);
    if (trajectory.format != TrajectoryFormat::kitti || flags.times.empty()) return trajectory;
    own.times = flags.times;
    return own.read(path, flag);
  };
  SpatialTrajectory estimate = read(flags.of_estimate, flags.estimate, "--from");
  const SpatialTrajectory reference = read(flags.of_reference, flags.reference, "--reference-from");
  const bool has_kitti =
      estimate.format == TrajectoryFormat::kitti || reference.format == TrajectoryFormat::kitti;
  if (!flags.times.empty() && !has_kitti) {
    throw InputError("--times: only KITTI poses need times; neither trajectory is of that format");
  }
  const bool by_index = are_paired_by_index(flags, estimate, reference);
  shift_times(estimate, flags.time_offset_s);
  const Paired pairs = paired(flags, estimate, reference);
  const PlanePair planes{
      plane_of(flags.of_estimate, flags.plane, "--plane", estimate.format),
      plane_of(flags.of_reference, flags.plane, "--reference-plane", reference.format)};
  const SpatialAccuracy judged =
      spatial_accuracy(pairs.estimate, pairs.reference, planes, alignment);
  if (leaves_an_error(pairs.estimate.size(), on_plane(alignment)) && !judged.accuracy) {
    throw InputError(flags.estimate, "has errors too large for a number");
  }
  const EvaluationHead head{flags.alignment, estimate.poses.size(), by_index, pairs.indices};
  print("%s", evaluation_text(judged, head, {flags.steps, flags.distances_m}).c_str());
  context.status = kDone;
}

}  // namespace

void add_evaluate(CLI::App& program, Context& context) {
  auto flags = std::make_shared<EvaluateFlags>();
  Command command(program, "evaluate", "Judge a trajectory by a reference",
                  "Example: fathom evaluate runs/run/trajectory.tum runs/run/ground_truth.tum\n"
                  "         fathom evaluate vio.tum mav0/state_groundtruth_estimate0/data.csv "
                  "--align yaw");
  command.argument("estimate", flags->estimate, "Trajectory (TUM, KITTI or EuRoC)");
  command.argument("reference", flags->reference, "Reference trajectory (the same)");
  command.text("--align,--alignment", flags->alignment, "ALIGNMENT",
               "none, origin, se2 or yaw; never scale");
  command.real("--tolerance,--max-difference", flags->max_difference_s, Range::at_least(0.0), "S",
               "Time stamps that belong together differ by no more (s)");
  command.real("--time-offset", flags->time_offset_s, Range::between(-9e9, 9e9), "S",
               "Added to the time stamps of the trajectory (s)");
  command.text("--plane", flags->plane, "PLANE",
               "What both are projected onto: xy, xz, yz or fit; else xz for KITTI, xy for others");
  command.text("--reference-plane", flags->of_reference.plane, "PLANE",
               "Of the reference, where it has other axes");
  command.text("--from", flags->of_estimate.format, "FORMAT",
               "tum, kitti or euroc; else by the content");
  command.text("--reference-from", flags->of_reference.format, "FORMAT", "Of the reference");
  command.text("--times", flags->times, "FILE", "Times of KITTI poses, one a line (s)");
  command.integers("--step", flags->steps, Range::at_least(1), "N",
                   "Relative error over so many poses (repeatable)");
  command.reals("--distance", flags->distances_m, Range::positive(), "M",
                "and over so many metres (repeatable)");
  command.quiet();
  command.on_run([flags, &context] { evaluate_files(*flags, context); });
}

}  // namespace fathom
