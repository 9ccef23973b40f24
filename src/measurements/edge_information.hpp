#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "fathom/measurements/graph_conversion.hpp"
#include "g2o_file.hpp"

namespace fathom {

/// Six values of a line as a matrix. g2o: xx xy xt yy yt tt. TORO: xx xy yy tt xt yt.
Eigen::Matrix3d information_of(const std::array<double, 6>& values, GraphFormat order);

/// Reads the information of edges. Those that are not positive definite are told at the end: where
/// all edges of a tag would be in the order of the other tag, once, as that is what they are.
class EdgeInformation {
 public:
  /// Nothing where it is not positive definite.
  std::optional<Eigen::Matrix3d> read(const std::array<double, 6>& values, GraphFormat order,
                                      std::size_t line);
  void tell(const G2oFault& fault) const;

 private:
  struct Edges {
    std::size_t count = 0;
    std::size_t fit_other_order = 0;
    std::vector<std::size_t> refused;  ///< lines
  };
  std::array<Edges, 2> edges_;  ///< by order
};

}  // namespace fathom
