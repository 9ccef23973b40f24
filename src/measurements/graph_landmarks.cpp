#include "graph_landmarks.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace fathom {

bool is_of_landmarks(std::string_view tag) {
  constexpr std::array<std::string_view, 5> kTags{"VERTEX_XY", "EDGE_SE2_XY", "EDGE_BEARING_SE2_XY",
                                                  "EDGE_SE2_XY_OFFSET", "EDGE_XY_XY"};
  return std::find(kTags.begin(), kTags.end(), tag) != kTags.end();
}

void TagCounts::add(std::string_view tag) {
  const auto found = std::find_if(counts_.begin(), counts_.end(),
                                  [&](const auto& entry) { return entry.first == tag; });
  if (found == counts_.end()) {
    counts_.emplace_back(tag, 1);
  } else {
    ++found->second;
  }
}

void refuse_landmarks(const TagCounts& landmarks, std::size_t line, const G2oFault& fault) {
  std::string all;
  for (const auto& [tag, count] : landmarks.counts()) {
    all += fmt::format("{}{} {}", all.empty() ? "" : ", ", count, tag);
  }
  fault(line, fmt::format("landmarks ({}), which are not read, and the graph is another one "
                          "without them; expected poses alone: 'fathom convert --drop-landmarks' "
                          "writes the graph of these",
                          all));
}

}  // namespace fathom
