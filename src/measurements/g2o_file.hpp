#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"
#include "fathom/measurements/shared_errors.hpp"

namespace fathom {

/// The lines of a g2o file, each understood by itself; ids as the file has them.
struct G2oFile {
  struct Vertex {
    Pose pose;
    std::size_t line = 0;
  };
  struct Edge {
    std::int64_t from = 0;
    std::int64_t to = 0;
    Pose motion;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    std::optional<int> inliers;
    double repeats = 1.0;                        ///< as told
    bool repeats_own = false;                    ///< of its own part in `shared` alone
    std::shared_ptr<const SharedErrors> shared;  ///< of a file beside it
    std::size_t line = 0;
  };
  struct Prior {
    std::int64_t id = 0;
    Pose pose;
    Eigen::Matrix3d information;  ///< positive semi-definite
    /// What `# start` above it says: the prior is the log's start, of this covariance.
    std::optional<Eigen::Matrix3d> start_covariance;
    std::size_t line = 0;
  };
  struct Fixed {
    std::int64_t id = 0;
    std::size_t line = 0;
  };

  std::map<std::int64_t, Vertex> vertices;
  std::vector<Edge> edges;
  std::vector<Prior> priors;
  /// `# hole`: what was declared of a step that was not measured, by its two ids; of several lines
  /// the first.
  std::map<std::pair<std::int64_t, std::int64_t>, Edge> holes;
  std::vector<Fixed> fixed;
  std::size_t self_edges = 0;  ///< from a pose to itself: left out
  std::size_t lines = 0;

  /// All ids, of vertices and edges, rising, each with its keyframe index.
  std::map<std::int64_t, std::size_t> keyframes() const;

  /// Whether its lowest id is held: by FIX, or because no prior says where the graph is.
  bool is_start_fixed() const;
};

/// Error callback: the line that cannot be used and what is wrong with it. If it returns, the line
/// is left out and reading goes on.
using G2oFault = std::function<void(std::size_t line, const std::string& what)>;

/// Edges from a pose to itself are faults, or left out and counted.
G2oFile scan_g2o(const std::string& content, const G2oFault& fault, bool drop_self_edges = false);

/// Faults of the file as a whole: edges to vertices and priors of vertices that it does not define.
void check_references(const G2oFile& file, const G2oFault& fault);

/// FIX of another id than the lowest.
void check_fixed(const G2oFile& file, const G2oFault& fault);

/// Index of the edge that is the dead reckoning of keyframe k ≥ 1, out of `edges`, the indices
/// of the edges whose later keyframe it is; nothing if there is none, or if the file declares the
/// step a hole: then the edges between its ends are registrations. `ids` of all keyframes.
std::optional<std::size_t> find_step(const G2oFile& file, const std::vector<std::size_t>& edges,
                                     std::size_t k, const std::vector<std::int64_t>& ids);

/// Where to point at for a pose: its vertex, else the first of its edges.
std::size_t line_about(const G2oFile& file, std::int64_t id);

}  // namespace fathom
