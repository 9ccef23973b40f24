// Rigid motions of whole subtrees, noted at their tops until somebody asks where a keyframe is.
// Motions noted further up are later ones: a clique is told only when all above it are settled.

#include "estimators/incremental_smoother/clique_tree.hpp"

namespace fathom::incremental_smoother {
namespace {

using Motion = std::optional<RigidMotion>;

Motion composed(const Motion& later, const Motion& earlier) {
  if (!later) return earlier;
  return earlier ? later->after(*earlier) : later;
}

}  // namespace

void CliqueTree::begin_update() {
  drop_updates();
  ++update_;
  followers_.clear();
}

void CliqueTree::note_before_update(int clique) {
  FollowedMotion& f = cliques_[at(clique)].followed;
  if (f.set_in == update_) return;
  f.set_in = update_;
  f.before_update = f.motion;
  followers_.push_back(clique);
}

void CliqueTree::follow(int clique, const RigidMotion& rigid) {
  note_before_update(clique);
  FollowedMotion& f = cliques_[at(clique)].followed;
  f.motion = composed(rigid, f.motion);
  has_followers_ = true;
}

// All above it must be settled.
void CliqueTree::settle_clique(int clique) {
  Clique& c = cliques_[at(clique)];
  FollowedMotion& f = c.followed;
  f.settled_in = step_;
  if (!f.motion) return;
  const bool is_new = f.set_in == update_;
  const Motion& before = is_new ? f.before_update : f.motion;
  for (int j = 0; j < c.width; ++j) {
    const int v = c.variables[at(j)];
    Node& node = problem_.nodes[at(v)];
    if (is_new) problem_.save(v, before ? (*before)(node) : node);
    node = (*f.motion)(node);
  }
  for (const int child : c.children) {
    if (is_new) note_before_update(child);
    FollowedMotion& below = cliques_[at(child)].followed;
    if (below.set_in == update_) below.before_update = composed(before, below.before_update);
    below.motion = composed(f.motion, below.motion);
  }
  f.motion.reset();
  f.before_update.reset();
}

void CliqueTree::settle_path(int clique) {
  stack_.clear();
  for (int i = clique; i >= 0 && cliques_[at(i)].followed.settled_in != step_;
       i = cliques_[at(i)].parent) {
    stack_.push_back(i);
  }
  for (; !stack_.empty(); stack_.pop_back()) settle_clique(stack_.back());
}

void CliqueTree::settle(int keyframe) {
  if (has_followers_ && at(keyframe) < clique_of_.size()) settle_path(clique_of_[at(keyframe)]);
}

void CliqueTree::settle() {
  if (!has_followers_) return;
  if (root_ >= 0) stack_.assign(1, root_);
  while (!stack_.empty()) {
    const int i = stack_.back();
    stack_.pop_back();
    settle_clique(i);
    const std::vector<int>& children = cliques_[at(i)].children;
    stack_.insert(stack_.end(), children.begin(), children.end());
  }
  has_followers_ = false;
}

void CliqueTree::drop_motions() {
  for (Clique& c : cliques_) {
    c.followed.motion.reset();
    c.followed.before_update.reset();
  }
  has_followers_ = false;
}

void CliqueTree::forget_update() {
  for (const int i : followers_) {
    FollowedMotion& f = cliques_[at(i)].followed;
    if (f.motion) f.motion = f.before_update;
  }
}

}  // namespace fathom::incremental_smoother
