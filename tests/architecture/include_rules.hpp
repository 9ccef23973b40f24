#pragma once

#include <string>
#include <vector>

namespace fathom::test {

/// One `#include` of a file of ours.
struct Include {
  std::string file;    ///< from the top of the checkout, such as "src/geometry/pose.cpp"
  int line = 0;        ///< from 1
  std::string target;  ///< between the brackets or quotes
  bool angled = false;
};

/// The includes of a file's text, in order; those in comments left out.
std::vector<Include> includes_of(const std::string& file, const std::string& text);

/// What breaks the design's table of modules (DESIGN.md, section 2), as "FILE:LINE: what is wrong";
/// empty where the include is allowed.
std::string complaint_about(const Include& include);

/// The same of a link edge between two CMake targets, such as "fathom_vision" to "fathom_geometry".
/// Targets that are none of ours are judged by what is included of them.
std::string complaint_about_link(const std::string& target, const std::string& linked);

}  // namespace fathom::test
