#include "estimators/support/pose_graph/chordal.hpp"

#include <cmath>

namespace fathom::pose_graph {
// z = a + i b as (a, b), the number e^{iδ} as the matrix R(δ) of a rotation: an edge adds w I to
// both diagonal blocks and −w R(δ) to the block in the row of `to`.
std::vector<double> chordal_headings(const sparse::Symbolic& symbolic, std::span<const Edge> edges,
                                     double first_rad) {
  sparse::BlockCholesky<2> factor(symbolic);
  factor.clear();
  const std::vector<int>& position = symbolic.position;
  std::vector<double> z(2 * position.size(), 0.0);
  for (const Edge& edge : edges) {
    const double w = heading_information(edge);
    const double c = w * std::cos(edge.theta);
    const double s = w * std::sin(edge.theta);
    for (const int keyframe : {edge.from, edge.to}) {
      if (keyframe == 0) continue;
      const sparse::BlockPlace place = factor.place(keyframe - 1, keyframe - 1);
      factor.data()[place.offset] += w;
      factor.data()[place.offset + at(place.stride) + 1] += w;
    }
    if (edge.from > 0 && edge.to > 0) {
      const sparse::BlockPlace place = factor.place(edge.from - 1, edge.to - 1);
      const bool to_is_row = position[at(edge.to - 1)] > position[at(edge.from - 1)];
      const double turn = to_is_row ? s : -s;
      double* block = factor.data() + place.offset;
      block[0] -= c;
      block[1] -= turn;
      block[place.stride] += turn;
      block[place.stride + 1] -= c;
    } else {
      const int free = edge.from > 0 ? edge.from : edge.to;
      double* right = z.data() + 2 * at(position[at(free - 1)]);
      right[0] += c;
      right[1] += edge.to > 0 ? s : -s;
    }
  }
  if (factor.factorise()) factor.solve(z.data());
  std::vector<double> theta{first_rad};
  theta.reserve(position.size() + 1);
  for (const int p : position) {
    theta.push_back(first_rad + std::atan2(z[at(2 * p + 1)], z[at(2 * p)]));
  }
  return theta;
}

}  // namespace fathom::pose_graph
