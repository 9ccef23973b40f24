// What the lines of a g2o file say together.

#include <algorithm>
#include <fmt/format.h>

#include "g2o_file.hpp"

namespace fathom {
namespace {

void check_priors(const G2oFile& file, const std::map<std::int64_t, std::size_t>& keyframes,
                  const G2oFault& fault) {
  for (const G2oFile::Prior& prior : file.priors) {
    if (keyframes.contains(prior.id)) continue;
    const std::string id = std::to_string(prior.id);
    fault(prior.line, file.vertices.empty()
                          ? "the prior is of pose " + id + ", of which the file has no edge"
                          : "the prior is of vertex " + id + ", which the file does not define");
  }
}

}  // namespace

std::map<std::int64_t, std::size_t> G2oFile::keyframes() const {
  std::map<std::int64_t, std::size_t> keyframe_of;
  for (const auto& [id, vertex] : vertices) keyframe_of.emplace(id, 0);
  for (const Edge& edge : edges) {
    keyframe_of.emplace(edge.from, 0);
    keyframe_of.emplace(edge.to, 0);
  }
  std::size_t next = 0;
  for (auto& [id, keyframe] : keyframe_of) keyframe = next++;
  return keyframe_of;
}

bool G2oFile::is_start_fixed() const {
  return !fixed.empty() || std::all_of(priors.begin(), priors.end(), [](const Prior& prior) {
    return prior.information.isZero(0.0);
  });
}

void check_references(const G2oFile& file, const G2oFault& fault) {
  for (const G2oFile::Edge& edge : file.edges) {
    for (const std::int64_t id : {edge.from, edge.to}) {
      if (!file.vertices.empty() && !file.vertices.contains(id)) {
        fault(edge.line, "the edge refers to vertex " + std::to_string(id) +
                             ", which the file does not define");
      }
    }
  }
  if (!file.priors.empty()) check_priors(file, file.keyframes(), fault);
}

void check_fixed(const G2oFile& file, const G2oFault& fault) {
  if (file.fixed.empty()) return;
  const auto keyframes = file.keyframes();
  const std::int64_t lowest = keyframes.begin()->first;
  for (const G2oFile::Fixed& fixed : file.fixed) {
    if (fixed.id != lowest) {
      fault(fixed.line, fmt::format("FIX {}: only the lowest id ({}) can be fixed{}", fixed.id,
                                    lowest, file.priors.empty() ? ", and it always is" : ""));
    }
  }
}

std::optional<std::size_t> find_step(const G2oFile& file, const std::vector<std::size_t>& edges,
                                     std::size_t k, const std::vector<std::int64_t>& ids) {
  if (file.holes.contains({ids[k - 1], ids[k]})) return std::nullopt;
  const auto joins = [&](std::int64_t from, std::int64_t to) {
    return std::find_if(edges.begin(), edges.end(), [&](std::size_t e) {
      return file.edges[e].from == from && file.edges[e].to == to;
    });
  };
  auto found = joins(ids[k - 1], ids[k]);
  if (found == edges.end()) found = joins(ids[k], ids[k - 1]);
  if (found == edges.end()) return std::nullopt;
  return *found;
}

std::size_t line_about(const G2oFile& file, std::int64_t id) {
  const auto vertex = file.vertices.find(id);
  if (vertex != file.vertices.end()) return vertex->second.line;
  for (const G2oFile::Edge& edge : file.edges) {
    if (edge.from == id || edge.to == id) return edge.line;
  }
  return file.lines;
}

}  // namespace fathom
