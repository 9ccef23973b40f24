#pragma once

#include <deque>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/incremental_smoother/variables.hpp"
#include "estimators/support/pose_graph/picture_states.hpp"

namespace fathom::incremental_smoother {

using pose_graph::Edge;
using pose_graph::Node;

/// The errors n that registrations of a picture share, as unknowns, and which of the edges share.
/// Of an edge's ends the `node` is the keyframe, or −1 where n is none of the unknowns: then what
/// the picture's errors do adds to the edge's own covariance.
///
/// That is so of a picture with a single registration where `folds_singles`: the same least squares
/// with fewer unknowns, though not under a loss, which takes the own part alone. Its second
/// registration unfolds it.
class Pictures {
 public:
  explicit Pictures(bool folds_singles) : folds_singles_(folds_singles) {}
  Pictures(const Pictures&) = delete;  // edges point into it
  Pictures& operator=(const Pictures&) = delete;
  Pictures(Pictures&&) = delete;
  Pictures& operator=(Pictures&&) = delete;
  ~Pictures() = default;

  bool is_empty() const { return told_.empty(); }
  /// Whether n of this keyframe is among the unknowns.
  bool has(int keyframe) const {
    return at(keyframe) < pictures_.size() && pictures_[at(keyframe)].is_unknown;
  }

  /// The only edge of a picture whose n is folded into it; −1: there is none.
  int folded_edge(int keyframe) const;
  /// n of a picture becomes unknown, at its optimum for the poses as they are: what its edge says
  /// of these is as before.
  void unfold(int keyframe, std::vector<Edge>& edges, std::span<const Node> poses);
  /// The newest edge shares this. A picture of it that was folded must be unfolded before.
  void add(const SharedErrors& shared, std::vector<Edge>& edges);
  /// Of the edges, those from `count` on are gone.
  void forget(int count, std::vector<Edge>& edges);

  /// The graph with the errors behind the keyframes.
  pose_graph::ExtendedGraph extended(std::vector<Edge> edges, std::span<const Node> poses) const;
  /// Takes the errors of a solution.
  void keep(const pose_graph::ExtendedGraph& solved);

  /// What a folded edge says of the errors of another registration's pictures: of Σ G n over those
  /// that are folded into it −X W ν is known, and X W Xᵀ of its covariance Σ G Gᵀ.
  struct Folded {
    int edge = 0;
    Eigen::Matrix3d X = Eigen::Matrix3d::Zero();
  };
  std::vector<Folded> folded_of(const RelativePose& z, std::span<const Edge> edges) const;
  /// A registration as it is left when the errors of its pictures, as estimated, are taken out: of
  /// its own covariance. What a gate tests. The poses of folded edges must be up to date.
  RelativePose without_errors(const RelativePose& z, std::span<const Edge> edges,
                              std::span<const Node> poses) const;

  std::vector<Node> errors;  ///< n by keyframe; zero where it is none of the unknowns

 private:
  struct Told {
    int edge = 0;
    pose_graph::SharedEnds ends;
    Eigen::Matrix3d own;
  };
  struct Picture {
    int registrations = 0;
    std::size_t first = 0;  ///< of its registrations in told_
    bool is_unknown = false;
  };

  /// Of an edge, less the errors that are unknowns.
  Eigen::Vector3d residual(const Edge& edge, std::span<const Node> poses) const;
  Eigen::Vector3d n_of(std::size_t keyframe) const;
  void set_unknown(int keyframe, bool is_unknown);
  /// W of its edge, and whether the edge shares.
  static void set_edge(Told& told, std::vector<Edge>& edges);
  static pose_graph::SharedEnds::End& end_of(Told& told, const Edge& edge, int keyframe) {
    return edge.from == keyframe ? told.ends.from : told.ends.to;
  }

  bool folds_singles_;
  std::deque<Told> told_;          // places stay
  std::vector<Picture> pictures_;  // by keyframe
};

}  // namespace fathom::incremental_smoother
