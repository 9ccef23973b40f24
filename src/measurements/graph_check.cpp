#include "fathom/measurements/graph_check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include <Eigen/Eigenvalues>

#include "fathom/core/files.hpp"
#include "fathom/core/text.hpp"
#include "g2o_file.hpp"
#include "graph_components.hpp"

namespace fathom {
namespace {

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

// Widens a range; NaN is left out.
void widen(double value, double& smallest, double& largest) {
  if (value < smallest) smallest = value;
  if (value > largest) largest = value;
}

void add_prior(const G2oFile::Prior& prior, PriorSummary& summary) {
  const Eigen::Matrix3d& information = prior.information;
  const Eigen::Matrix2d position = information.topLeftCorner<2, 2>();
  const bool has_heading = information(2, 2) > 0.0;
  const bool has_position = !position.isZero(0.0);
  ++(has_heading    ? has_position ? summary.of_both : summary.of_heading
     : has_position ? summary.of_position
                    : summary.of_nothing);
  // Of each kind by itself: by the eigenvalues, as one direction may not be measured.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(position, Eigen::EigenvaluesOnly);
  for (const double value : solver.eigenvalues()) {
    if (!(value > 1e-12 * position.trace())) continue;
    widen(1.0 / std::sqrt(value), summary.smallest_sigma_m, summary.largest_sigma_m);
  }
  if (!has_heading) return;
  widen(1.0 / std::sqrt(information(2, 2)), summary.smallest_sigma_rad, summary.largest_sigma_rad);
}

void count_priors(const G2oFile& file, PriorSummary& summary) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  summary.smallest_sigma_m = kInfinity;
  summary.smallest_sigma_rad = kInfinity;
  for (const G2oFile::Prior& prior : file.priors) add_prior(prior, summary);
}

// Which edges are odometry edges, by the rule of the reader.
void count_steps(const G2oFile& file, const GraphComponents& components, GraphSummary& summary) {
  const auto keyframe_of = file.keyframes();
  const std::vector<std::int64_t>& ids = components.ids;
  std::vector<std::vector<std::size_t>> edges_of(ids.size());
  for (std::size_t e = 0; e < file.edges.size(); ++e) {
    edges_of[keyframe_of.at(std::max(file.edges[e].from, file.edges[e].to))].push_back(e);
  }
  for (std::size_t k = 1; k < ids.size(); ++k) {
    const auto step = find_step(file, edges_of[k], k, ids);
    ++(step ? summary.odometry_edges : summary.holes);
    for (const std::size_t e : edges_of[k]) {
      if (step && e == *step) continue;
      ++summary.loops;
      if (file.edges[e].from > file.edges[e].to) ++summary.backward_loops;
    }
  }
  summary.holes -= components.borders.size();
}

// Those that leave the file out of use are faults.
void check_components(const G2oFile& file, GraphSummary& summary, const G2oFault& fault) {
  const GraphComponents components = components_of(file);
  for (const auto& members : components.members) {
    summary.components.push_back(
        {members.size(), components.ids[members.front()], components.ids[members.back()]});
  }
  summary.borders = components.borders;
  if (components.members.size() > 1) {
    fault(line_about(file, summary.components[1].first_id), several_components(components));
  } else {
    check_held(file, components, 0, fault);
  }
  count_steps(file, components, summary);
}

// Headings are wrapped as they are read.
std::size_t count_turned_edges(const std::string& content) {
  std::size_t count = 0;
  for (const TextLine& line : lines_of(content)) {
    if (!line.text.starts_with("EDGE_SE2 ") && !line.text.starts_with("EDGE2 ")) continue;
    if (line.text.size() > kLongestRow) continue;
    const auto fields = split(line.text);
    const auto heading = fields.size() > 5 ? parse_real(fields[5]) : std::nullopt;
    if (heading && std::abs(*heading) > 2.0 * M_PI) ++count;
  }
  return count;
}

// What refers to nothing is left out of what follows.
void leave_out_strays(G2oFile& file) {
  const auto keyframe_of = file.keyframes();
  std::erase_if(file.priors, [&](const auto& prior) { return !keyframe_of.contains(prior.id); });
}

}  // namespace

GraphSummary summarise_graph(const std::filesystem::path& path, const GraphOptions& options) {
  const std::string content = read_text(path);
  GraphSummary summary;
  const G2oFault fault = [&](std::size_t line, const std::string& what) {
    summary.faults.push_back(fmt::format("{}:{}: {}", path.string(), line, what));
  };
  G2oFile file = scan_g2o(content, fault, options.drop_self_edges);
  if (file.edges.empty() && file.vertices.empty()) {
    summary.faults.push_back(path.string() + ": holds no pose graph: no vertex and no edge");
    return summary;
  }
  check_references(file, fault);
  leave_out_strays(file);
  check_fixed(file, fault);
  summary.vertices = file.vertices.size();
  summary.poses = file.keyframes().size();
  summary.edges = file.edges.size();
  summary.turned_edges = count_turned_edges(content);
  summary.is_start_fixed = file.is_start_fixed();
  summary.smallest_sigma_m = std::numeric_limits<double>::infinity();
  summary.smallest_sigma_rad = std::numeric_limits<double>::infinity();
  for (const G2oFile::Edge& edge : file.edges) add_edge(edge, summary);
  count_priors(file, summary.priors);
  check_components(file, summary, fault);
  return summary;
}

std::optional<InformationScale> information_scale(const MeasurementLog& log,
                                                  std::span<const Pose> optimum) {
  const double degrees = degrees_of_freedom(log);
  if (!(degrees > 0.0)) return std::nullopt;
  InformationScale scale;
  const auto add = [&](const Eigen::Vector3d& e, const Eigen::Matrix3d& information) {
    const Eigen::Vector3d weighted = information * e;
    scale.per_degree_of_freedom += e.dot(weighted) / degrees;
    scale.squared += weighted.squaredNorm() / degrees;
  };
  for (const RelativePose& z : log.edges()) {
    add(residual(z.motion, optimum[z.from], optimum[z.to]), z.alone().information);
  }
  const AbsolutePose start = log.start().measurement();
  if (!log.start().is_fixed()) add(residual(start, optimum[0]), start.information);
  for (std::size_t k = 0; k < log.size(); ++k) {
    for (const AbsolutePose& z : log.arrival(k).absolute) {
      add(residual(z, optimum[k]), z.information);
    }
  }
  scale.looks_like_square_roots =
      scale.per_degree_of_freedom < 0.1 && scale.squared > 0.5 && scale.squared < 2.0;
  return scale;
}

}  // namespace fathom
