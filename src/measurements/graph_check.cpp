#include "fathom/measurements/graph_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Eigenvalues>

#include "fathom/core/files.hpp"
#include "g2o_file.hpp"

namespace fathom {
namespace {

class Components {
 public:
  explicit Components(std::size_t count) : parent_(count), left_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  void connect(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    parent_[b] = a;
    --left_;
  }

  std::size_t count() const { return left_; }

 private:
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  std::vector<std::size_t> parent_;
  std::size_t left_;
};

void add_edge(const G2oFile::Edge& edge, GraphSummary& summary) {
  using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;
  const Eigen::Vector3d values = Solver(edge.information, Eigen::EigenvaluesOnly).eigenvalues();
  // NaN-safe: rounding can make the smallest eigenvalue of a scaled matrix negative.
  if (!(values.maxCoeff() <= kMaxCondition * values.minCoeff())) ++summary.badly_conditioned;
  const Eigen::Vector3d sigma = edge.information.inverse().diagonal().cwiseAbs().cwiseSqrt();
  summary.smallest_sigma_m = std::min({summary.smallest_sigma_m, sigma.x(), sigma.y()});
  summary.largest_sigma_m = std::max({summary.largest_sigma_m, sigma.x(), sigma.y()});
  summary.smallest_sigma_rad = std::min(summary.smallest_sigma_rad, sigma.z());
  summary.largest_sigma_rad = std::max(summary.largest_sigma_rad, sigma.z());
}

// Which edges are odometry edges, by the rule of the reader; a keyframe without one is a fault.
void count_steps(const G2oFile& file, GraphSummary& summary, const G2oFault& fault) {
  const auto keyframe_of = file.keyframes();
  std::vector<std::vector<std::size_t>> edges_of(keyframe_of.size());
  for (std::size_t e = 0; e < file.edges.size(); ++e) {
    edges_of[keyframe_of.at(std::max(file.edges[e].from, file.edges[e].to))].push_back(e);
  }
  std::vector<std::int64_t> ids;
  ids.reserve(keyframe_of.size());
  for (const auto& [id, keyframe] : keyframe_of) ids.push_back(id);
  for (std::size_t k = 1; k < ids.size(); ++k) {
    const auto step = find_step(file, edges_of[k], k, ids);
    if (step) {
      ++summary.odometry_edges;
    } else {
      const auto vertex = file.vertices.find(ids[k]);
      fault(vertex != file.vertices.end() ? vertex->second.line
            : edges_of[k].empty()         ? file.lines
                                          : file.edges[edges_of[k].front()].line,
            "pose " + std::to_string(ids[k]) + " has no odometry edge from pose " +
                std::to_string(ids[k - 1]) + ", the one before it");
    }
    for (const std::size_t e : edges_of[k]) {
      if (step && e == *step) continue;
      ++summary.loops;
      if (file.edges[e].from > file.edges[e].to) ++summary.backward_loops;
    }
  }
}

}  // namespace

GraphSummary summarise_graph(const std::filesystem::path& path) {
  const std::string content = read_text(path);
  GraphSummary summary;
  const G2oFault fault = [&](std::size_t line, const std::string& what) {
    summary.faults.push_back(path.string() + ":" + std::to_string(line) + ": " + what);
  };
  const G2oFile file = scan_g2o(content, fault);
  if (file.edges.empty() && file.vertices.empty()) {
    summary.faults.push_back(path.string() + ": holds no pose graph: no vertex and no edge");
    return summary;
  }
  check_references(file, fault);
  const auto keyframe_of = file.keyframes();
  summary.vertices = file.vertices.size();
  summary.poses = keyframe_of.size();
  summary.edges = file.edges.size();
  summary.smallest_sigma_m = std::numeric_limits<double>::infinity();
  summary.smallest_sigma_rad = std::numeric_limits<double>::infinity();
  Components components(keyframe_of.size());
  for (const G2oFile::Edge& edge : file.edges) {
    components.connect(keyframe_of.at(edge.from), keyframe_of.at(edge.to));
    add_edge(edge, summary);
  }
  summary.components = components.count();
  count_steps(file, summary, fault);
  return summary;
}

std::optional<InformationScale> information_scale(const MeasurementLog& log,
                                                  std::span<const Pose> optimum) {
  if (log.registration_count() == 0) return std::nullopt;
  const double degrees = 3.0 * static_cast<double>(log.registration_count());
  InformationScale scale;
  for (const RelativePose& z : log.edges()) {
    const Eigen::Vector3d e = residual(z.motion, optimum[z.from], optimum[z.to]);
    const Eigen::Vector3d weighted = z.information * e;
    scale.per_degree_of_freedom += e.dot(weighted) / degrees;
    scale.squared += weighted.squaredNorm() / degrees;
  }
  scale.looks_like_square_roots =
      scale.per_degree_of_freedom < 0.1 && scale.squared > 0.5 && scale.squared < 2.0;
  return scale;
}

}  // namespace fathom
