#include "fathom/measurements/g2o.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "g2o_file.hpp"

namespace fathom {
namespace {

using KeyframeOf = std::map<std::int64_t, std::size_t>;

RelativePose measurement(const G2oFile::Edge& edge, const KeyframeOf& keyframe_of) {
  RelativePose z;
  z.from = keyframe_of.at(edge.from);
  z.to = keyframe_of.at(edge.to);
  z.motion = edge.motion;
  z.information = edge.information;
  z.inliers = edge.inliers;
  return z;
}

// Where to point at for a keyframe that lacks its odometry edge.
std::size_t line_about(const G2oFile& file, std::int64_t id,
                       const std::vector<std::size_t>& edges) {
  const auto vertex = file.vertices.find(id);
  if (vertex != file.vertices.end()) return vertex->second.line;
  return edges.empty() ? file.lines : file.edges[edges.front()].line;
}

MeasurementLog build_log(const G2oFile& file, const G2oFault& fault) {
  const KeyframeOf keyframe_of = file.keyframes();
  // Per keyframe, the indices of its edges in file order; its step is one of them.
  std::vector<std::vector<std::size_t>> edges_of(keyframe_of.size());
  for (std::size_t e = 0; e < file.edges.size(); ++e) {
    const G2oFile::Edge& edge = file.edges[e];
    edges_of[keyframe_of.at(std::max(edge.from, edge.to))].push_back(e);
  }
  MeasurementLog log(file.vertices.empty() ? Pose{} : file.vertices.begin()->second.pose);
  for (const auto& [id, keyframe] : keyframe_of) log.ids.push_back(id);
  for (std::size_t k = 1; k < log.ids.size(); ++k) {
    const auto step = find_step(file, edges_of[k], k, log.ids);
    if (!step) {
      fault(line_about(file, log.ids[k], edges_of[k]),
            "pose " + std::to_string(log.ids[k]) + " has no odometry edge from pose " +
                std::to_string(log.ids[k - 1]) + ", the one before it");
    }
    log.add_keyframe(measurement(file.edges[*step], keyframe_of));
    for (const std::size_t e : edges_of[k]) {
      if (e != *step) log.add_registration(measurement(file.edges[e], keyframe_of));
    }
  }
  if (!file.vertices.empty()) {
    log.guess.emplace();
    for (const auto& [id, vertex] : file.vertices) log.guess->push_back(vertex.pose);
  }
  return log;
}

std::string vertex_line(std::int64_t id, const Pose& pose) {
  return "VERTEX_SE2 " + std::to_string(id) + ' ' + exact(pose.x) + ' ' + exact(pose.y) + ' ' +
         exact(pose.theta) + '\n';
}

std::string edge_line(const RelativePose& z, const std::vector<std::int64_t>& ids) {
  std::string line;
  if (z.inliers) line += "# inliers " + std::to_string(*z.inliers) + '\n';
  line += "EDGE_SE2 " + std::to_string(ids[z.from]) + ' ' + std::to_string(ids[z.to]) + ' ' +
          exact(z.motion.x) + ' ' + exact(z.motion.y) + ' ' + exact(z.motion.theta);
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) line += ' ' + exact(z.information(row, column));
  }
  return line + '\n';
}

}  // namespace

MeasurementLog read_g2o(const std::filesystem::path& path) {
  return parse_g2o(read_text(path), path.string());
}

MeasurementLog parse_g2o(const std::string& content, const std::string& name) {
  const G2oFault fault = [&name](std::size_t line, const std::string& what) {
    throw InputError(name, line, what);
  };
  const G2oFile file = scan_g2o(content, fault);
  if (file.edges.empty() && file.vertices.empty()) {
    throw InputError(name, "holds no pose graph: no vertex and no edge");
  }
  check_references(file, fault);
  return build_log(file, fault);
}

std::string to_g2o(const MeasurementLog& log) {
  std::vector<std::int64_t> ids = log.ids;
  for (std::size_t k = ids.size(); k < log.size(); ++k) ids.push_back(static_cast<std::int64_t>(k));
  const std::vector<Pose> poses = log.odometry();
  std::string text = vertex_line(ids[0], poses[0]) + "FIX " + std::to_string(ids[0]) + '\n';
  for (std::size_t k = 1; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    text += vertex_line(ids[k], poses[k]) + edge_line(arrival.step, ids);
    for (const RelativePose& z : arrival.registrations) text += edge_line(z, ids);
  }
  return text;
}

}  // namespace fathom
