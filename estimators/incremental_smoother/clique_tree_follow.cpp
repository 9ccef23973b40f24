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
  problem_.begin_update();
  drop_updates();
  ++update_;
  following_.told.clear();
}

void CliqueTree::note_before_update(int clique) {
  FollowedMotion& f = cliques_[at(clique)].followed;
  if (f.set_in == update_) return;
  f.set_in = update_;
  f.before_update = f.motion;
  following_.told.push_back(clique);
}

void CliqueTree::follow(int clique, const RigidMotion& rigid) {
  note_before_update(clique);
  FollowedMotion& f = cliques_[at(clique)].followed;
  f.motion = composed(rigid, f.motion);
  following_.has_any = true;
}

// All above it must be settled.
void CliqueTree::settle_clique(int clique) {
  Clique& c = cliques_[at(clique)];
  FollowedMotion& f = c.followed;
  f.settled_in = last_.number;
  if (!f.motion) return;
  const bool is_new = f.set_in == update_;
  const Motion& before = is_new ? f.before_update : f.motion;
  for (int j = 0; j < c.width; ++j) {
    const int v = c.variables[at(j)];
    if (is_errors(v)) continue;
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
  work_.stack.clear();
  for (int i = clique; i >= 0 && cliques_[at(i)].followed.settled_in != last_.number;
       i = cliques_[at(i)].parent) {
    work_.stack.push_back(i);
  }
  for (; !work_.stack.empty(); work_.stack.pop_back()) settle_clique(work_.stack.back());
}

void CliqueTree::settle(int keyframe) {
  if (following_.has_any && at(keyframe) < order_.clique_of.poses.size()) {
    settle_path(order_.clique_of[keyframe]);
  }
}

void CliqueTree::settle() {
  if (!following_.has_any) return;
  if (order_.root >= 0) work_.stack.assign(1, order_.root);
  while (!work_.stack.empty()) {
    const int i = work_.stack.back();
    work_.stack.pop_back();
    settle_clique(i);
    const std::vector<int>& children = cliques_[at(i)].children;
    work_.stack.insert(work_.stack.end(), children.begin(), children.end());
  }
  following_.has_any = false;
}

void CliqueTree::place(const ByVariable<Node>& nodes) {
  for (Clique& c : cliques_) {
    c.followed.motion.reset();
    c.followed.before_update.reset();
  }
  following_.has_any = false;
  problem_.nodes = nodes.poses;
  problem_.pictures.errors = nodes.errors;
}

void CliqueTree::forget_update() {
  for (const int i : following_.told) {
    FollowedMotion& f = cliques_[at(i)].followed;
    if (f.motion) f.motion = f.before_update;
  }
  problem_.restore_saved();
  settle();
}

}  // namespace fathom::incremental_smoother
