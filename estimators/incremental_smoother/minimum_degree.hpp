#pragma once

#include <cstdint>
#include <vector>

#include "estimators/incremental_smoother/variables.hpp"

namespace fathom::incremental_smoother {

/// The quotient graph of what is left to eliminate (George and Liu 1981): the nodes 0 … size − 1,
/// their links, and the elements, each a set of nodes that are all linked with one another by what
/// was eliminated before.
struct QuotientGraph {
  int size = 0;
  std::vector<sparse::Link> links;
  std::vector<int> element_start{0};
  std::vector<int> element_nodes;

  void clear();
  int elements() const { return static_cast<int>(element_start.size()) - 1; }
};

/// An order of elimination of small fill, node `newest` last but one, `fixed` last. Up to some
/// thousand nodes minimum degree with the true degrees, on sets of bits; beyond, approximate
/// minimum degree.
class MinimumDegree {
 public:
  /// Nodes 0 … first − 1 go before all others, but where approximate minimum degree is at work.
  const std::vector<int>& order(const QuotientGraph& graph, int first, int newest, int fixed);

 private:
  void order_by_bits(const QuotientGraph& graph, int first, int newest, int fixed);
  void order_approximately(const QuotientGraph& graph);
  std::uint64_t* row(int v) { return bits_.data() + at(v) * at(words_); }
  void fill_rows(const QuotientGraph& graph);
  void begin(const QuotientGraph& graph);
  int count(int v);
  void put(int v);
  void take(int v);

  int words_ = 0;
  std::vector<std::uint64_t> bits_;
  std::vector<std::uint64_t> mask_;
  std::vector<int> degree_;
  std::vector<int> head_;  ///< by degree
  std::vector<int> tail_;
  std::vector<int> next_;
  std::vector<int> previous_;
  std::vector<int> order_;
};

}  // namespace fathom::incremental_smoother
