#pragma once

#include <vector>

#include "estimators/support/pose_graph/normal_equations.hpp"
#include "tests/estimators/logs.hpp"

namespace fathom::test {

/// A log as the solvers of pose graphs take it, at dead reckoning.
struct GraphParts {
  std::vector<pose_graph::Edge> edges;
  std::vector<char> is_loop;
  std::vector<pose_graph::Node> nodes;

  sparse::Symbolic analysed() const {
    return pose_graph::analyse_graph(edges, static_cast<int>(nodes.size()));
  }
  std::vector<std::size_t> loops() const {
    std::vector<std::size_t> indices;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      if (is_loop[e] != 0) indices.push_back(e);
    }
    return indices;
  }
};

inline GraphParts parts_of(const MeasurementLog& log) {
  GraphParts parts;
  for (std::size_t k = 1; k < log.size(); ++k) {
    parts.edges.push_back(pose_graph::make_edge(log.arrival(k).step));
    parts.is_loop.push_back(0);
    for (const RelativePose& z : log.arrival(k).registrations) {
      parts.edges.push_back(pose_graph::make_edge(z));
      parts.is_loop.push_back(1);
    }
  }
  parts.nodes = pose_graph::nodes_of(log.odometry());
  return parts;
}

/// circle_log with so many keyframes.
inline MeasurementLog circle_of(std::size_t keyframes, double noise = 1.0) {
  LogOptions options;
  options.keyframes = keyframes;
  options.noise = noise;
  return circle_log(options);
}

}  // namespace fathom::test
