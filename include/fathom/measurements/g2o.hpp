#pragma once

#include <filesystem>
#include <numbers>
#include <optional>
#include <span>
#include <string>

#include "fathom/core/options.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// What a reader does where a graph leaves something open.
struct GraphOptions {
  /// Of a hole, a step without an odometry edge: the standard deviations of its guess, along x and
  /// y each and of the heading. A batch solve does not look at them.
  double gap_sigma_m = 100.0;
  double gap_sigma_rad = std::numbers::pi;
  /// From 1 on: that component of the graph alone, ids as they are.
  std::optional<int> component;
  /// Edges from a pose to itself, whose residual no pose changes: left out and counted, else
  /// refused.
  bool drop_self_edges = false;

  void describe(OptionTable& table);
};

/// Reads a 2-D pose graph as a measurement log (docs/formats.md).
///
/// Understood: `VERTEX_SE2`, `EDGE_SE2`, `FIX`, `EDGE_PRIOR_SE2`, `EDGE_PRIOR_SE2_XY`, TORO's
/// `VERTEX2` and `EDGE2` (information in the order xx xy yy tt xt yt), `#` comments, files without
/// vertices, edges written backwards, several edges between one pair, ids with gaps. Landmarks and
/// EQUIV are refused. Replay:
/// keyframes are the ids in rising order; the first edge from the id before to k is k's dead
/// reckoning (failing one, the first written the other way; failing both, a hole); every other edge
/// is a registration that arrives with its later keyframe, in file order, as a prior does with its
/// keyframe.
///
/// Keyframe 0 is fixed at its vertex, or at the identity where the file has none. In a file with
/// priors and no `FIX` it is free (StartPose): the priors hold the graph. with_start_of_priors
/// makes a start of them.
///
/// A file beside it may tell the errors of its registrations apart (shared_file_of).
///
/// Throws InputError with file and line on anything it cannot use: also on a graph of several
/// components, and on one that its priors do not hold.
MeasurementLog read_g2o(const std::filesystem::path& path, const GraphOptions& options = {});

/// A file of shared errors in memory (docs/formats.md); `name` stands for it in messages.
struct SharedText {
  std::string content;
  std::string name;
};

/// As read_g2o, of text in memory; `name` stands for the file in messages.
MeasurementLog parse_g2o(const std::string& content, const std::string& name,
                         const GraphOptions& options = {}, const SharedText* shared = nullptr);

/// A log in order of arrival: for each keyframe its vertex (the dead-reckoned pose), its step, its
/// registrations, its absolute measurements. Keyframe 0 has FIX if it is fixed; an uncertain start
/// is a prior. A hole has no edge. Reads back to the same bits: inliers, what is declared of a hole
/// and the covariance of the start stand in comments.
std::string to_g2o(const MeasurementLog& log);
/// The same with these poses, one a keyframe, in place of dead reckoning's.
std::string to_g2o(const MeasurementLog& log, std::span<const Pose> vertices);

/// A free start made known by the priors of keyframe 0, as keyframe by keyframe it is needed: those
/// that together determine it and could all be met are the start, so that F is the same; the others
/// stay absolute measurements. Any other log is as it was. Throws InputError with `name` if they do
/// not determine it.
MeasurementLog with_start_of_priors(const MeasurementLog& log, const std::string& name);

}  // namespace fathom
