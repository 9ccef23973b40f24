#include "estimators/support/sparse/elimination_tree.hpp"

namespace fathom::sparse {

std::vector<int> elimination_tree(const Adjacency& graph, const std::vector<int>& order,
                                  const std::vector<int>& position) {
  std::vector<int> parent(order.size(), -1);
  std::vector<int> ancestor(order.size(), -1);
  for (int j = 0; j < graph.size(); ++j) {
    const int v = order[at(j)];
    for (int p = graph.start[at(v)]; p < graph.start[at(v) + 1]; ++p) {
      int i = position[at(graph.neighbours[at(p)])];
      while (i >= 0 && i < j) {
        const int next = ancestor[at(i)];
        ancestor[at(i)] = j;
        if (next < 0) parent[at(i)] = j;
        i = next;
      }
    }
  }
  return parent;
}

std::vector<int> postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> first_child(at(n), -1);
  std::vector<int> sibling(at(n), -1);
  std::vector<int> stack;
  for (int j = n - 1; j >= 0; --j) {
    if (parent[at(j)] < 0) {
      stack.push_back(j);
    } else {
      sibling[at(j)] = first_child[at(parent[at(j)])];
      first_child[at(parent[at(j)])] = j;
    }
  }
  std::vector<int> order;
  order.reserve(at(n));
  while (!stack.empty()) {
    const int j = stack.back();
    const int child = first_child[at(j)];
    if (child < 0) {
      order.push_back(j);
      stack.pop_back();
    } else {
      first_child[at(j)] = sibling[at(child)];
      stack.push_back(child);
    }
  }
  return order;
}

bool is_worth_merging(int width, std::size_t zeros, std::size_t blocks) {
  const double share = static_cast<double>(zeros) / static_cast<double>(blocks);
  if (width <= 2) return share < 0.5;
  if (width <= 4) return share < 0.3;
  if (width <= 12) return share < 0.15;
  return share < 0.05;
}

std::size_t blocks_of(int width, int height) {
  return at(width) * (at(width) + 1) / 2 + at(width) * at(height);
}

}  // namespace fathom::sparse
