// A log as the text of a g2o file.

#include <string>
#include <vector>

#include "fathom/core/text.hpp"
#include "fathom/measurements/g2o.hpp"

namespace fathom {
namespace {

std::string upper_triangle(const Eigen::Matrix3d& matrix) {
  std::string text;
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) text += ' ' + exact(matrix(row, column));
  }
  return text;
}

std::string pose_text(const Pose& pose) {
  return ' ' + exact(pose.x) + ' ' + exact(pose.y) + ' ' + exact(pose.theta);
}

std::string vertex_line(std::int64_t id, const Pose& pose) {
  return "VERTEX_SE2 " + std::to_string(id) + pose_text(pose) + '\n';
}

std::string edge_line(const RelativePose& z, const std::vector<std::int64_t>& ids) {
  std::string line;
  if (z.inliers) line += "# inliers " + std::to_string(*z.inliers) + '\n';
  if (z.repeats != 1.0) {
    // Of the part that is its own, which a file beside it tells, or of all.
    line += "# repeats " + exact(z.repeats) + (z.shared ? " own" : "") + '\n';
  }
  line += z.is_hole ? "# hole " : "EDGE_SE2 ";
  line += std::to_string(ids[z.from]) + ' ' + std::to_string(ids[z.to]);
  return line + pose_text(z.motion) + upper_triangle(z.information) + '\n';
}

std::string prior_line(const AbsolutePose& z, const std::vector<std::int64_t>& ids) {
  const std::string id = std::to_string(ids[z.keyframe]);
  const Eigen::Matrix3d& information = z.information;
  const bool is_position =
      z.pose.theta == 0.0 && information.col(2).isZero(0.0) && !information.isZero(0.0);
  if (!is_position) {
    return "EDGE_PRIOR_SE2 " + id + pose_text(z.pose) + upper_triangle(information) + '\n';
  }
  return "EDGE_PRIOR_SE2_XY " + id + ' ' + exact(z.pose.x) + ' ' + exact(z.pose.y) + ' ' +
         exact(information(0, 0)) + ' ' + exact(information(0, 1)) + ' ' +
         exact(information(1, 1)) + '\n';
}

std::string start_lines(const StartPose& start, const std::vector<std::int64_t>& ids) {
  if (start.is_fixed()) return "FIX " + std::to_string(ids[0]) + '\n';
  if (start.is_free) return {};
  return "# start" + upper_triangle(start.covariance) + '\n' + prior_line(start.measurement(), ids);
}

}  // namespace

std::string to_g2o(const MeasurementLog& log) {
  return to_g2o(log, log.odometry());
}

std::string to_g2o(const MeasurementLog& log, std::span<const Pose> vertices) {
  std::vector<std::int64_t> ids = log.ids;
  for (std::size_t k = ids.size(); k < log.size(); ++k) ids.push_back(static_cast<std::int64_t>(k));
  std::string text;
  for (std::size_t k = 0; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    text += vertex_line(ids[k], vertices[k]);
    text += k == 0 ? start_lines(log.start(), ids)
                   : edge_line(arrival.step.is_hole ? arrival.step.forward() : arrival.step, ids);
    for (const RelativePose& z : arrival.registrations) text += edge_line(z, ids);
    for (const AbsolutePose& z : arrival.absolute) text += prior_line(z, ids);
  }
  return text;
}

}  // namespace fathom
