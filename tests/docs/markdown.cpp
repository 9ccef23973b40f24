#include "docs/markdown.hpp"

#include <algorithm>
#include <fstream>
#include <regex>
#include <stdexcept>

namespace fathom::test {
namespace {

// Lower case, punctuation dropped, blanks to hyphens. Letters beyond ASCII stay as they are.
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80 || std::isalnum(byte) || c == '-' || c == '_') {
      anchor += static_cast<char>(byte < 0x80 ? std::tolower(byte) : byte);
    } else if (c == ' ') {
      anchor += '-';
    }
  }
  return anchor;
}

CodeBlock opened_by(const std::string& line) {
  static const std::regex form(R"re(```(\w*)(?: title="([^"]*)")?)re");
  std::smatch parts;
  if (!std::regex_match(line, parts, form)) throw std::runtime_error("not a fence: " + line);
  return {parts[1], parts[2], {}, {}};
}

// The heading that it is, if any, becomes the section.
void read_text(const std::string& line, std::string& section, MarkdownPage& page) {
  static const std::regex heading(R"(#+ (.*))");
  static const std::regex code(R"(`[^`]*`)");
  static const std::regex link(R"(\]\(([^)\s]+)\))");
  std::smatch parts;
  if (std::regex_match(line, parts, heading)) {
    section = parts[1];
    page.anchors.push_back(anchor_of(section));
  }
  const std::string text = std::regex_replace(line, code, "code");
  for (std::sregex_iterator found(text.begin(), text.end(), link), end; found != end; ++found) {
    page.links.push_back((*found)[1]);
  }
}

}  // namespace

MarkdownPage read_markdown(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path.string() + " cannot be read");
  MarkdownPage page;
  std::string section;
  bool in_block = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("```")) {
      in_block = !in_block;
      if (!in_block) continue;
      page.blocks.push_back(opened_by(line));
      page.blocks.back().section = section;
    } else if (in_block) {
      page.blocks.back().lines.push_back(line);
    } else {
      read_text(line, section, page);
    }
  }
  if (in_block) throw std::runtime_error(path.string() + ": a fence is left open");
  return page;
}

}  // namespace fathom::test
