// What CliqueTree eliminates again, and in which order.

#include <algorithm>

#include "estimators/incremental_smoother/clique_tree.hpp"

namespace fathom::incremental_smoother {

void CliqueTree::find_affected(std::span<const int> variables) {
  unmark();
  again_.affected.clear();
  for (const int v : variables) {
    if (order_.clique_of[v] >= 0) {
      mark_up(v);
    } else if (again_.index_of[v] < 0) {
      again_.index_of[v] = 0;
      again_.affected.push_back(v);
    }
  }
  for (const int i : marked_) {
    settle_path(i);
    const Clique& c = cliques_[at(i)];
    again_.affected.insert(again_.affected.end(), c.variables.begin(),
                           c.variables.begin() + c.width);
  }
  sort_affected();
  for (std::size_t i = 0; i < again_.affected.size(); ++i) {
    again_.index_of[again_.affected[i]] = static_cast<int>(i);
  }
}

// Keyframe 0, which is not eliminated, is the last, and what its picture's registrations share goes
// before it.
void CliqueTree::sort_affected() {
  std::vector<int>& affected = again_.affected;
  again_.has_errors = std::ranges::any_of(affected, is_errors);
  if (!again_.has_errors) {
    std::sort(affected.begin(), affected.end());
  } else {
    std::ranges::sort(affected, {},
                      [](int v) { return 2L * keyframe_of(v) + (is_errors(v) ? 0 : 1); });
    if (affected.front() == errors_of(0)) {
      std::rotate(affected.begin(), affected.begin() + 1, affected.end());
    }
  }
  affected.push_back(0);
}

void CliqueTree::form_quotient_graph() {
  again_.quotient.clear();
  again_.quotient.size = static_cast<int>(again_.affected.size());
  for (const int v : again_.affected) {
    problem_.for_each_linked(v, [&](int other) {
      if (other < v && again_.index_of[other] >= 0) {
        again_.quotient.links.push_back({again_.index_of[v], again_.index_of[other]});
      }
    });
  }
  again_.orphans.clear();
  for (const int i : marked_) {
    for (const int child : cliques_[at(i)].children) {
      const Clique& c = cliques_[at(child)];
      if (c.is_marked) continue;
      again_.orphans.push_back(child);
      for (int j = c.width; j < c.rows(); ++j) {
        again_.quotient.element_nodes.push_back(again_.index_of[c.variables[at(j)]]);
      }
      again_.quotient.element_start.push_back(
          static_cast<int>(again_.quotient.element_nodes.size()));
    }
  }
}

// Who is linked with the errors of a picture is linked with its pose, and an element that has them
// has it, too.
void CliqueTree::form_keyframe_graph() {
  const QuotientGraph& all = again_.quotient;
  QuotientGraph& keyframes = again_.keyframes;
  keyframes.clear();
  again_.index_of_pose.assign(again_.affected.size(), -1);
  again_.pose_at.clear();
  for (int i = 0; i < all.size; ++i) {
    if (is_errors(again_.affected[at(i)])) continue;
    again_.index_of_pose[at(i)] = keyframes.size++;
    again_.pose_at.push_back(i);
  }
  for (const auto& [i, k] : all.links) {
    const int a = again_.index_of_pose[at(i)];
    const int b = again_.index_of_pose[at(k)];
    if (a >= 0 && b >= 0) keyframes.links.push_back({a, b});
  }
  for (int g = 0; g < all.elements(); ++g) {
    for (int p = all.element_start[at(g)]; p < all.element_start[at(g) + 1]; ++p) {
      const int pose = again_.index_of_pose[at(all.element_nodes[at(p)])];
      if (pose >= 0) keyframes.element_nodes.push_back(pose);
    }
    keyframes.element_start.push_back(static_cast<int>(keyframes.element_nodes.size()));
  }
}

// How many of the affected keyframes are older than this one; none where there are few.
int CliqueTree::older_than(int keyframe) const {
  constexpr int kFew = 50;
  const auto older = static_cast<int>(
      std::ranges::count_if(again_.affected, [&](int v) { return v > 0 && v < keyframe; }));
  return older < kFew ? 0 : older;
}

// The affected in an order of small fill; errors directly before the pose of their picture.
const std::vector<int>& CliqueTree::ordered(int first, int newest) {
  const int index = again_.index_of[newest];
  if (!again_.has_errors) {
    return again_.minimum_degree.order(again_.quotient, first, index, again_.quotient.size - 1);
  }
  form_keyframe_graph();
  const std::vector<int>& poses = again_.minimum_degree.order(
      again_.keyframes, first, again_.index_of_pose[at(index)], again_.keyframes.size - 1);
  again_.order.clear();
  for (const int pose : poses) {
    const int i = again_.pose_at[at(pose)];
    if (i > 0 && again_.affected[at(i - 1)] == errors_of(again_.affected[at(i)])) {
      again_.order.push_back(i - 1);
    }
    again_.order.push_back(i);
  }
  return again_.order;
}

}  // namespace fathom::incremental_smoother
