#include "docs/examples.hpp"

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using Lines = std::vector<std::string>;

Lines read_lines(const fs::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path.string() + " cannot be read");
  Lines lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

void write_lines(const fs::path& path, const Lines& lines) {
  fs::create_directories(path.parent_path());
  std::ofstream file(path);
  for (const std::string& line : lines) file << line << '\n';
}

// The lines that a hunk wants there are replaced by those that it leaves.
void apply_hunk(const Lines& wanted, const Lines& left, const std::string& file, Lines& lines) {
  const auto found = std::search(lines.begin(), lines.end(), wanted.begin(), wanted.end());
  if (wanted.empty() || found == lines.end()) {
    throw std::runtime_error(file + " has no lines as in the hunk that begins with '" +
                             (wanted.empty() ? "" : wanted.front()) + "'");
  }
  if (std::search(found + 1, lines.end(), wanted.begin(), wanted.end()) != lines.end()) {
    throw std::runtime_error(file + " has '" + wanted.front() + "' and what follows twice");
  }
  const auto place = lines.erase(found, found + static_cast<std::ptrdiff_t>(wanted.size()));
  lines.insert(place, left.begin(), left.end());
}

int apply_diff(const CodeBlock& block, const fs::path& path) {
  Lines lines = read_lines(path);
  int added = 0;
  Lines wanted;
  Lines left;
  const auto end_hunk = [&] {
    apply_hunk(wanted, left, block.title, lines);
    wanted.clear();
    left.clear();
  };
  for (const std::string& line : block.lines) {
    if (line == "@@") {
      end_hunk();
      continue;
    }
    const char sign = line.empty() ? ' ' : line.front();
    const std::string text = line.empty() ? "" : line.substr(1);
    if (sign != '+') wanted.push_back(text);
    if (sign != '-') left.push_back(text);
    added += sign == '+' ? 1 : 0;
  }
  end_hunk();
  write_lines(path, lines);
  return added;
}

}  // namespace

std::vector<FileChange> apply_examples(const MarkdownPage& page, const fs::path& top) {
  std::vector<FileChange> changes;
  for (const CodeBlock& block : page.blocks) {
    if (block.title.empty()) continue;
    FileChange change{block.section, block.title, block.language != "diff",
                      static_cast<int>(block.lines.size())};
    const fs::path path = top / block.title;
    if (!change.is_new) {
      change.lines_added = apply_diff(block, path);
    } else if (fs::exists(path)) {
      throw std::runtime_error(block.title + " is there already");
    } else {
      write_lines(path, block.lines);
    }
    changes.push_back(change);
  }
  return changes;
}

}  // namespace fathom::test
