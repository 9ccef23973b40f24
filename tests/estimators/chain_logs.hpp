#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <Eigen/Dense>

#include "fathom/core/random.hpp"
#include "tests/estimators/graph_parts.hpp"

namespace fathom::test {

struct Loop {
  std::size_t from = 0;
  std::size_t to = 0;
};

inline Eigen::Matrix3d correlated(RandomStream& random, double scale) {
  const Eigen::Matrix3d half =
      Eigen::Matrix3d::NullaryExpr([&](Eigen::Index, Eigen::Index) { return random.normal(); });
  const Eigen::Vector3d sigma{0.03, 0.02, 0.004};
  return scale * scale * sigma.asDiagonal() *
         (half * half.transpose() + 0.3 * Eigen::Matrix3d::Identity()) * sigma.asDiagonal();
}

// Twice round a circle, so that headings pass ±π, with full covariances. `share` of the noise that
// these state is drawn.
inline MeasurementLog circled_twice(std::size_t keyframes, const std::vector<Loop>& loops,
                                    double share) {
  RandomStream random(7, "chains");
  const auto truth = [&](std::size_t k) {
    const double at =
        4.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(keyframes - 1);
    return Pose{10.0 * std::cos(at), 10.0 * std::sin(at), wrap_angle(at + 0.5 * std::numbers::pi)};
  };
  const auto measured = [&](std::size_t from, std::size_t to, double scale) {
    const Eigen::Matrix3d C = correlated(random, scale);
    const Eigen::Matrix3d L = C.llt().matrixL();
    const Eigen::Vector3d n =
        share * L * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    Pose z = between(truth(from), truth(to));
    z = {z.x + n.x(), z.y + n.y(), wrap_angle(z.theta + n.z())};
    return RelativePose::from_covariance(from, to, z, C);
  };
  MeasurementLog log(truth(0));
  for (std::size_t k = 1; k < keyframes; ++k) {
    log.add_keyframe(measured(k - 1, k, 1.0));
    for (const Loop& loop : loops) {
      if (loop.to == k) log.add_registration(measured(loop.from, k, 2.0));
    }
  }
  return log;
}

// Chains of none to seven keyframes, one of many and one that is open; two loops between the ends
// of one chain, of which one runs backwards.
inline const std::vector<Loop> kOfAllLengths{{0, 40},  {1, 41},  {3, 42},  {6, 43}, {10, 44},
                                             {15, 45}, {21, 46}, {28, 47}, {0, 47}};

inline const std::vector<Loop> kLoops{{0, 50}, {12, 61}, {13, 62}, {30, 80}, {31, 80}};

inline GraphParts parts_of_all_lengths(Loop last = {28, 80}) {
  std::vector<Loop> loops = kOfAllLengths;
  loops.push_back(last);
  GraphParts parts = parts_of(circled_twice(100, loops, 1.0));
  pose_graph::Edge back = parts.edges[40];
  back.from = 28;
  back.to = 21;
  back.x = -3.0;
  parts.edges.push_back(back);
  return parts;
}

struct Derivatives {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
};

// ½F's Gauss-Newton matrix and gradient, dense, by the rows of all edges; node 0 is fixed.
inline Derivatives dense(std::span<const pose_graph::Edge> edges,
                         std::span<const pose_graph::Node> nodes) {
  const auto n = static_cast<Eigen::Index>(3 * (nodes.size() - 1));
  Derivatives d{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (const pose_graph::Edge& edge : edges) {
    const pose_graph::Node& i = nodes[static_cast<std::size_t>(edge.from)];
    const pose_graph::Node& k = nodes[static_cast<std::size_t>(edge.to)];
    Eigen::Matrix3d P;
    P << i.c, i.s, 0.0, -i.s, i.c, 0.0, 0.0, 0.0, 1.0;
    Eigen::Matrix3d T = Eigen::Matrix3d::Identity();
    T(0, 2) = -(k.y - i.y);
    T(1, 2) = k.x - i.x;
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, n);
    if (edge.to > 0) J.middleCols<3>(3 * (edge.to - 1)) += P;
    if (edge.from > 0) J.middleCols<3>(3 * (edge.from - 1)) -= P * T;
    const Eigen::Matrix3d W = pose_graph::full(edge.W);
    d.H += J.transpose() * W * J;
    d.g += J.transpose() * W * pose_graph::residual_of(edge, i, k);
  }
  return d;
}

}  // namespace fathom::test
