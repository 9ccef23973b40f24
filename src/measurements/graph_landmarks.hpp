#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "g2o_file.hpp"

namespace fathom {

/// Whether a line with this tag is a landmark, or what a pose sees of one.
bool is_of_landmarks(std::string_view tag);

/// Tags with the number of their lines, in the order of their first.
class TagCounts {
 public:
  void add(std::string_view tag);
  const std::vector<std::pair<std::string, std::size_t>>& counts() const { return counts_; }

 private:
  std::vector<std::pair<std::string, std::size_t>> counts_;
};

/// That a graph has landmarks, the first of them on this line.
void refuse_landmarks(const TagCounts& landmarks, std::size_t line, const G2oFault& fault);

}  // namespace fathom
