#include "graph_components.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>

#include "fathom/core/disjoint_sets.hpp"
#include "rigid_rank.hpp"

namespace fathom {
namespace {

using KeyframeOf = std::map<std::int64_t, std::size_t>;

// A pose of every keyframe by a chain of edges from the first of its set, which stands at a heading
// that no axis of a measurement is parallel to by chance.
std::vector<Pose> chained_poses(const G2oFile& file, const KeyframeOf& keyframe_of) {
  std::vector<std::vector<const G2oFile::Edge*>> edges_of(keyframe_of.size());
  for (const G2oFile::Edge& edge : file.edges) {
    edges_of[keyframe_of.at(edge.from)].push_back(&edge);
    edges_of[keyframe_of.at(edge.to)].push_back(&edge);
  }
  std::vector<Pose> poses(keyframe_of.size());
  std::vector<bool> is_placed(keyframe_of.size(), false);
  std::vector<std::size_t> open;
  for (std::size_t first = 0; first < poses.size(); ++first) {
    if (is_placed[first]) continue;
    constexpr double kAnyHeading = 0.7;
    poses[first] = {0.0, 0.0, kAnyHeading};
    is_placed[first] = true;
    open.assign(1, first);
    while (!open.empty()) {
      const std::size_t k = open.back();
      open.pop_back();
      for (const G2oFile::Edge* edge : edges_of[k]) {
        const std::size_t from = keyframe_of.at(edge->from);
        const std::size_t other = from == k ? keyframe_of.at(edge->to) : from;
        if (is_placed[other]) continue;
        poses[other] = compose(poses[k], from == k ? edge->motion : inverse(edge->motion));
        is_placed[other] = true;
        open.push_back(other);
      }
    }
  }
  return poses;
}

// The sets of the vertices that are fixed, by their roots, that of the lowest id first.
std::vector<std::size_t> fixed_sets(const G2oFile& file, const KeyframeOf& keyframe_of,
                                    DisjointSets& sets) {
  std::set<std::size_t> keyframes;
  for (const G2oFile::Fixed& fixed : file.fixed) {
    const auto keyframe = keyframe_of.find(fixed.id);
    if (keyframe != keyframe_of.end()) keyframes.insert(keyframe->second);
  }
  if (file.fixed.empty() && file.is_start_fixed()) keyframes.insert(0);
  std::vector<std::size_t> roots;
  roots.reserve(keyframes.size());
  for (const std::size_t k : keyframes) roots.push_back(sets.root(k));
  return roots;
}

// The sets that their priors hold, by their roots.
std::set<std::size_t> placed_sets(const G2oFile& file, const KeyframeOf& keyframe_of,
                                  DisjointSets& sets) {
  std::set<std::size_t> roots;
  if (file.priors.empty()) return roots;
  const std::vector<Pose> poses = chained_poses(file, keyframe_of);
  std::map<std::size_t, std::vector<HeldPose>> held;
  for (const G2oFile::Prior& prior : file.priors) {
    const std::size_t k = keyframe_of.at(prior.id);
    held[sets.root(k)].emplace_back(AbsolutePose{k, prior.pose, prior.information}, poses[k]);
  }
  for (const auto& [root, poses_of_set] : held) {
    if (rank_of_motions(poses_of_set) == 3) roots.insert(root);
  }
  return roots;
}

// The first few, and how many more there are.
template <class Items, class Text>
std::string listed(const Items& items, const char* between, Text text) {
  constexpr std::size_t kShown = 4;
  std::string list;
  for (std::size_t i = 0; i < std::min(items.size(), kShown); ++i) {
    list += (i > 0 ? between : "") + text(i);
  }
  if (items.size() > kShown) list += " and " + std::to_string(items.size() - kShown) + " more";
  return list;
}

}  // namespace

GraphComponents components_of(const G2oFile& file) {
  const KeyframeOf keyframe_of = file.keyframes();
  DisjointSets sets(keyframe_of.size());
  for (const G2oFile::Edge& edge : file.edges) {
    sets.join(keyframe_of.at(edge.from), keyframe_of.at(edge.to));
  }
  // A log has one start: the world joins what priors hold to the first vertex that is fixed. The
  // sets of the others stay by themselves, for each can be taken as a log of its own.
  const std::vector<std::size_t> fixed = fixed_sets(file, keyframe_of, sets);
  std::set<std::size_t> joined = placed_sets(file, keyframe_of, sets);
  if (!fixed.empty()) {
    for (const std::size_t root : fixed) joined.erase(root);
    joined.insert(fixed.front());
  }
  for (const std::size_t root : joined) sets.join(*joined.begin(), root);
  std::set<std::size_t> held_roots;
  for (const std::size_t root : fixed) held_roots.insert(sets.root(root));
  for (const std::size_t root : joined) held_roots.insert(sets.root(root));

  GraphComponents components;
  for (const auto& [id, keyframe] : keyframe_of) components.ids.push_back(id);
  std::map<std::size_t, std::size_t> place_of;  // by root
  for (std::size_t k = 0; k < components.ids.size(); ++k) {
    const std::size_t root = sets.root(k);
    const auto [place, is_new] = place_of.emplace(root, components.members.size());
    if (is_new) {
      components.members.emplace_back();
      components.is_held.push_back(held_roots.contains(root));
    }
    components.members[place->second].push_back(k);
    if (k > 0 && sets.root(k - 1) != root) {
      components.borders.emplace_back(components.ids[k - 1], components.ids[k]);
    }
  }
  return components;
}

std::string several_components(const GraphComponents& components) {
  const auto& members = components.members;
  const auto component = [&](std::size_t i) {
    const std::size_t poses = members[i].size();
    const std::int64_t first = components.ids[members[i].front()];
    return poses == 1 ? fmt::format("{}: 1 pose, {}", i + 1, first)
                      : fmt::format("{}: {} poses, {} to {}", i + 1, poses, first,
                                    components.ids[members[i].back()]);
  };
  const auto border = [&](std::size_t i) {
    return fmt::format("{}|{}", components.borders[i].first, components.borders[i].second);
  };
  return fmt::format(
      "the graph has {} components, which no edge and no prior joins ({}), with borders at {}; "
      "expected one: --component K or dataset.component takes it",
      members.size(), listed(members, "; ", component), listed(components.borders, ", ", border));
}

void check_held(const G2oFile& file, const GraphComponents& components, std::size_t index,
                const G2oFault& fault) {
  if (file.is_start_fixed() || components.is_held[index]) return;
  const auto has_position = [](const G2oFile::Prior& prior) {
    return !prior.information.topLeftCorner<2, 2>().isZero(0.0);
  };
  const bool is_placed = std::any_of(file.priors.begin(), file.priors.end(), has_position);
  fault(file.priors.front().line,
        fmt::format("no vertex is fixed, and the priors do not say the {} of the graph; expected a "
                    "prior that says it, or FIX {}",
                    is_placed ? "heading (or a direction of the position)" : "position",
                    components.ids[components.members[index].front()]));
}

G2oFile component_of(const G2oFile& file, const GraphComponents& components, std::size_t index) {
  std::set<std::int64_t> ids;
  for (const std::size_t k : components.members[index]) ids.insert(components.ids[k]);
  G2oFile part = file;
  std::erase_if(part.vertices, [&](const auto& entry) { return !ids.contains(entry.first); });
  std::erase_if(part.edges, [&](const auto& edge) { return !ids.contains(edge.from); });
  std::erase_if(part.priors, [&](const auto& prior) { return !ids.contains(prior.id); });
  std::erase_if(part.fixed, [&](const auto& fixed) { return !ids.contains(fixed.id); });
  return part;
}

}  // namespace fathom
