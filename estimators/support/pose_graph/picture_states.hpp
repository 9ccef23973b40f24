#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/support/pose_graph/edge.hpp"
#include "fathom/measurements/relative_pose.hpp"

namespace fathom::pose_graph {

/// A graph with the errors of its pictures among the nodes, behind the keyframes.
struct ExtendedGraph {
  ExtendedGraph() = default;
  ExtendedGraph(const ExtendedGraph&) = delete;  // it points into itself
  ExtendedGraph& operator=(const ExtendedGraph&) = delete;
  ExtendedGraph(ExtendedGraph&&) = default;
  ExtendedGraph& operator=(ExtendedGraph&&) = default;
  ~ExtendedGraph() = default;

  std::span<const Edge> edges;  ///< those given where nothing is told, else `own_edges`
  std::vector<Node> nodes;
  std::vector<Edge> own_edges;
  std::vector<SharedEnds> ends;
  std::vector<int> node_of;  ///< by keyframe, that of its picture's errors; −1 or beyond: none
};

/// The errors that registrations of a picture share, as unknowns of a graph: three numbers n a
/// picture, in units of their standard deviations (docs/shared_errors.md).
///
/// A picture with a single registration shares nothing: what its errors do adds to that
/// registration's own covariance, which is the same least squares with fewer unknowns. Not so under
/// a robust loss, which takes the own part alone.
class PictureStates {
 public:
  explicit PictureStates(bool folds_singles = true) : folds_singles_(folds_singles) {}

  bool is_empty() const { return told_.empty(); }

  /// The edge of a registration that tells what it shares, at its place among the edges; places
  /// rise.
  void add(const RelativePose& z, std::size_t edge);
  /// Those from this place on are taken back.
  void forget_from(std::size_t edge);

  /// The graph with the pictures' errors as they were last kept; an edge that shares has its own
  /// information. The edges must outlive it.
  ExtendedGraph extended(std::span<const Edge> edges, std::span<const Node> nodes) const;
  /// Keeps the errors of a solution.
  void keep(const ExtendedGraph& solved);
  /// As keep, at zero.
  void reset();

  /// As of without_shared, of the errors as estimated; one that tells nothing is as it is.
  RelativePose without_errors(const RelativePose& z) const;

 private:
  struct Told {
    std::size_t edge = 0;
    std::size_t from = 0;
    std::size_t to = 0;
    Eigen::Matrix3d G_from, G_to, own;
  };
  struct Picture {
    int registrations = 0;
    Eigen::Vector3d n = Eigen::Vector3d::Zero();
  };

  Eigen::Vector3d errors_of(std::size_t keyframe) const;

  bool folds_singles_;
  std::vector<Told> told_;
  std::vector<Picture> pictures_;  ///< by keyframe, up to the last that has one
};

}  // namespace fathom::pose_graph
