// The factorisation of CliqueTree, and which cliques keep what they say of their separators.
//
// The Schur complements take some ten times the memory of the factor, and only those at the border
// of what is eliminated are needed. Those that were not for longest are dropped. Who needs one that
// was dropped eliminates its subtree again, down to where they are kept: one is for every
// kMostDropped keyframes, whatever its age.

#include <algorithm>

#include "estimators/incremental_smoother/clique_tree.hpp"
#include "estimators/incremental_smoother/fronts.hpp"

namespace fathom::incremental_smoother {
namespace {

constexpr int kMostDropped = 512;
// Cliques that are factored before some of their updates may be dropped.
constexpr std::size_t kMostAtOnce = 512;

}  // namespace

bool CliqueTree::factor(std::span<const int> which) {
  refactored_ = 0;
  add_dropped(which);
  std::span<const int> left = work_.to_factor;
  while (left.size() > kMostAtOnce) {
    const auto some = left.first(kMostAtOnce);
    left = left.subspan(kMostAtOnce);
    if (!factor_some(some)) return false;
    for (const int i : some) {
      for (const int child : cliques_[at(i)].children) {
        if (updates_.kept > updates_.most) drop_update(cliques_[at(child)]);
      }
    }
  }
  return factor_some(left);
}

bool CliqueTree::factor_some(std::span<const int> which) {
  for (const int i : which) {
    Clique& c = cliques_[at(i)];
    refactored_ += c.width;
    make_room(c);
    queue(i);
    c.used_in = update_;
    for (const int child : c.children) cliques_[at(child)].used_in = update_;
  }
  FrontFactorisation run{problem_,
                         problem_.loops,
                         cliques_,
                         which,
                         {order_.when.poses.data(), order_.when.errors.data()},
                         pointer_to(work_.row_of),
                         work_.packed.data(),
                         work_.signs.data()};
  return sparse::run_for_processor(run);
}

// Those to factor: before these cliques come those whose updates they need and which have none.
void CliqueTree::add_dropped(std::span<const int> which) {
  for (const int i : which) {
    Clique& c = cliques_[at(i)];
    if (c.kept == Kept::no) c.kept = Kept::yes;
  }
  work_.to_factor.clear();
  const auto add_children = [&](const Clique& c) {
    for (const int i : c.children) {
      Clique& child = cliques_[at(i)];
      if (child.kept != Kept::no) continue;
      child.kept = Kept::yes;
      work_.stack.push_back(i);
    }
  };
  if (updates_.has_dropped) {
    work_.stack.clear();
    for (const int i : which) add_children(cliques_[at(i)]);
    while (!work_.stack.empty()) {
      const int i = work_.stack.back();
      work_.stack.pop_back();
      work_.to_factor.push_back(i);
      add_children(cliques_[at(i)]);
    }
    for (const int i : work_.to_factor) settle_path(i);
    std::ranges::reverse(work_.to_factor);
  }
  work_.to_factor.insert(work_.to_factor.end(), which.begin(), which.end());
}

void CliqueTree::make_room(Clique& c) {
  const std::size_t width = 3 * at(c.width);
  const std::size_t height = 3 * at(c.height);
  work_.packed.resize(std::max(work_.packed.size(), 3 * width));
  work_.signs.resize(std::max(work_.signs.size(), width));
  work_.gathered.resize(std::max(work_.gathered.size(), width + height));
  updates_.buffers.give_back(std::move(c.panel));
  release_update(c);
  c.panel = updates_.buffers.take((width + height) * width + kReadAhead);
  c.update = updates_.buffers.take(c.update_column(c.height));
  c.layout.resize(width + height);
  c.kept = Kept::yes;
  updates_.kept += c.update.size();
}

void CliqueTree::release_update(Clique& c) {
  if (c.kept == Kept::yes) updates_.kept -= c.update.size();
  c.kept = Kept::no;
  updates_.buffers.give_back(std::move(c.update));
}

void CliqueTree::queue(int clique) {
  Clique& c = cliques_[at(clique)];
  if (c.is_queued) return;
  c.is_queued = true;
  c.queued_in = update_;
  updates_.queue.push_back(clique);
}

// Not where too many keyframes would have to be eliminated again at once, those of what was dropped
// above it among them.
void CliqueTree::drop_update(Clique& c) {
  if (c.kept != Kept::yes) return;
  c.dropped = c.width;
  for (const int i : c.children) {
    const Clique& child = cliques_[at(i)];
    if (child.kept == Kept::no) c.dropped += child.dropped;
  }
  int most = c.dropped;
  for_each_dropped_above(
      c, [&](const Clique& above) { most = std::max(most, above.dropped + c.dropped); });
  updates_.kept -= c.update.size();
  if (most >= kMostDropped) {
    c.kept = Kept::lasting;
    return;
  }
  for_each_dropped_above(c, [&](Clique& above) { above.dropped += c.dropped; });
  // Not to the pool: the memory is wanted back.
  c.kept = Kept::no;
  std::vector<double>().swap(c.update);
  updates_.has_dropped = true;
}

// All but those that the last update needed. Each is looked at once.
void CliqueTree::drop_updates() {
  for (std::size_t left = updates_.queue.size(); left > 0 && updates_.kept > updates_.most;
       --left) {
    const int i = updates_.queue.front();
    updates_.queue.pop_front();
    Clique& c = cliques_[at(i)];
    c.is_queued = false;
    if (c.kept != Kept::yes) continue;
    if (c.used_in >= update_ || c.used_in > c.queued_in) {
      queue(i);
      c.queued_in = c.used_in;
    } else {
      drop_update(c);
    }
  }
}

}  // namespace fathom::incremental_smoother
