#include "fathom/estimation/stretches.hpp"

#include <algorithm>

namespace fathom {

void Stretches::add_node(bool after_hole) {
  if (after_hole) {
    const std::size_t last = stretch_of_.back();
    links_.push_back({stretch_of_.size(), last, links_.size() + 1, true});
  }
  stretch_of_.push_back(links_.size());
}

// Depth first.
std::vector<Stretches::Reached> Stretches::reached(std::size_t root,
                                                   std::optional<std::size_t> without) const {
  std::vector<std::vector<std::size_t>> links_of(links_.size() + 1);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (without == i) continue;
    links_of[links_[i].a].push_back(i);
    links_of[links_[i].b].push_back(i);
  }
  std::vector<Reached> all(links_.size() + 1);
  all[root].is_reached = true;
  std::vector<std::size_t> open{root};
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    for (const std::size_t i : links_of[at]) {
      const std::size_t next = links_[i].a == at ? links_[i].b : links_[i].a;
      if (all[next].is_reached) continue;
      all[next] = {i, at, true};
      open.push_back(next);
    }
  }
  return all;
}

std::vector<std::size_t> Stretches::links_between(std::size_t a, std::size_t b) const {
  std::vector<std::size_t> between;
  const std::size_t root = stretch_of_[a];
  const std::vector<Reached> all = reached(root, {});
  for (std::size_t at = stretch_of_[b]; at != root; at = all[at].from) {
    between.push_back(all[at].link);
  }
  return between;
}

std::optional<std::size_t> Stretches::open_hole(std::size_t a, std::size_t b) const {
  std::optional<std::size_t> last;
  for (const std::size_t i : links_between(a, b)) {
    if (links_[i].is_open) last = std::max(last.value_or(0), links_[i].node);
  }
  return last;
}

std::size_t Stretches::link_of(std::size_t hole) const {
  return static_cast<std::size_t>(std::ranges::find(links_, hole, &Link::node) - links_.begin());
}

std::vector<bool> Stretches::held_by(std::size_t hole) const {
  const std::vector<Reached> all = reached(0, link_of(hole));
  std::vector<bool> held;
  held.reserve(stretch_of_.size());
  for (const std::size_t stretch : stretch_of_) held.push_back(!all[stretch].is_reached);
  return held;
}

void Stretches::replace(std::size_t hole, std::size_t a, std::size_t b) {
  Link& link = links_[link_of(hole)];
  link = {link.node, stretch_of_[a], stretch_of_[b], false};
}

void Stretches::keep(std::size_t a, std::size_t b) {
  for (const std::size_t i : links_between(a, b)) links_[i].is_open = false;
}

bool Stretches::has_open() const {
  return std::ranges::any_of(links_, &Link::is_open);
}

}  // namespace fathom
