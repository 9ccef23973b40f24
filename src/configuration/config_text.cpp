#include "fathom/configuration/config_text.hpp"

#include <algorithm>

#include <yaml-cpp/yaml.h>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

// A value, or a map with its keys in the order in which they are first seen.
struct Node {
  const ConfigLine* line = nullptr;  // of a value
  std::vector<std::string> keys;
  std::vector<Node> entries;  // by key

  Node& operator[](const std::string& key) {
    const auto found = std::find(keys.begin(), keys.end(), key);
    const auto place = static_cast<std::size_t>(found - keys.begin());
    if (found == keys.end()) {
      keys.push_back(key);
      entries.emplace_back();
    }
    return entries[place];
  }
};

constexpr int kBraces = 2;              // the depth from which on maps may stand on one line
constexpr std::size_t kLineWidth = 90;  // of what stands in braces

Node tree_of(const std::vector<ConfigLine>& lines) {
  Node root;
  for (const ConfigLine& line : lines) {
    Node* node = &root;
    std::size_t begin = 0;
    for (int depth = 0; begin != std::string::npos; ++depth) {
      // A comment needs a line of its own.
      const bool is_last = depth + 1 == kBraces && !line.comment.empty();
      const std::size_t dot = is_last ? std::string::npos : line.key.find('.', begin);
      node = &(*node)[line.key.substr(begin, dot - begin)];
      begin = dot == std::string::npos ? dot : dot + 1;
    }
    node->line = &line;
  }
  return root;
}

std::string one_line(std::string text) {
  for (char& letter : text) {
    if (static_cast<unsigned char>(letter) < 0x20) letter = ' ';
  }
  return text;
}

// Where a value needs quotes, the emitter replaces bytes that are not UTF-8: a path would be
// another one.
void emit_word(YAML::Emitter& out, const std::string& word) {
  YAML::Emitter alone;
  alone << word;
  if (YAML::Load(alone.c_str()).as<std::string>() != word) {
    throw InputError(in_quotes(word) + " cannot stand in a configuration: it is not UTF-8");
  }
  out << word;
}

void emit_value(YAML::Emitter& out, const ConfigLine& line) {
  if (!line.is_list) {
    emit_word(out, line.value);
  } else {
    out << YAML::Flow << YAML::BeginSeq;
    for (const YAML::Node& item : YAML::Load(line.value)) emit_word(out, item.as<std::string>());
    out << YAML::EndSeq;
  }
  if (!line.comment.empty()) out << YAML::Comment(one_line(line.comment));
}

// Of an entry in braces, "key: value, " included.
std::size_t width_of(const std::string& key, const Node& node) {
  std::size_t width = key.size() + 4;
  if (node.line != nullptr) return width + node.line->value.size();
  for (std::size_t i = 0; i < node.keys.size(); ++i) {
    width += width_of(node.keys[i], node.entries[i]);
  }
  return width;
}

void emit(YAML::Emitter& out, const Node& node, int depth) {
  if (node.line != nullptr) return emit_value(out, *node.line);
  if (depth >= kBraces && width_of("", node) <= kLineWidth) out << YAML::Flow;
  out << YAML::BeginMap;
  for (std::size_t i = 0; i < node.keys.size(); ++i) {
    out << YAML::Key << node.keys[i] << YAML::Value;
    emit(out, node.entries[i], depth + 1);
  }
  out << YAML::EndMap;
}

}  // namespace

std::string config_text(const std::vector<ConfigLine>& lines) {
  YAML::Emitter out;
  emit(out, tree_of(lines), 0);
  return out.c_str() + std::string("\n");
}

}  // namespace fathom
