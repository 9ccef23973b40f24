#include "fathom/configuration/config_text.hpp"

#include <algorithm>
#include <cstdio>

namespace fathom {
namespace {

constexpr std::size_t kWidth = 100;

bool is_plain(const std::string& word) {
  constexpr const char* kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./+-";
  for (const char* const special : {"null", "Null", "NULL", "-", "---"}) {
    if (word == special) return false;
  }
  return !word.empty() && word.find_first_not_of(kPlain) == std::string::npos;
}

std::string one_line(std::string text) {
  for (char& letter : text) {
    if (static_cast<unsigned char>(letter) < 0x20) letter = ' ';
  }
  return text;
}

std::string part_of(const std::string& key) {
  return key.substr(0, key.find('.'));
}

// "{a: 1, b: 2}", broken before the line is too long.
std::string braced(const std::string& opening, const std::vector<ConfigLine>& lines) {
  std::string text = opening + "{";
  std::size_t start = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string item = lines[i].key + ": " + lines[i].value;
    if (i > 0) {
      text += ",";
      if (text.size() - start + item.size() + 2 > kWidth) {
        text += "\n";
        start = text.size();
        text += std::string(opening.size(), ' ');
      }
      text += " ";
    }
    text += item;
  }
  return text + "}\n";
}

// The lines whose keys go on after `part`, without it.
std::vector<ConfigLine> below(const std::vector<ConfigLine>& lines, const std::string& part) {
  std::vector<ConfigLine> own;
  for (const ConfigLine& line : lines) {
    if (!line.key.starts_with(part + ".")) continue;
    own.push_back({line.key.substr(part.size() + 1), line.value, line.comment});
  }
  return own;
}

std::string single_line(const std::string& indent, const ConfigLine& line) {
  if (line.value.empty()) return indent + "# " + one_line(line.key + ": " + line.comment) + "\n";
  return indent + line.key + ": " + line.value +
         (line.comment.empty() ? "" : "  # " + one_line(line.comment)) + "\n";
}

bool stands_alone(const ConfigLine& line) {
  return !line.comment.empty() || line.key.find('.') == std::string::npos;
}

std::string section(const std::vector<ConfigLine>& lines) {
  std::string text;
  std::string braced_parts = "\n";
  for (const ConfigLine& line : lines) {
    if (stands_alone(line)) {
      text += single_line("  ", line);
      continue;
    }
    const std::string part = part_of(line.key);
    if (braced_parts.find("\n" + part + "\n") != std::string::npos) continue;
    braced_parts += part + "\n";
    std::vector<ConfigLine> together;
    for (const ConfigLine& other : lines) {
      if (!stands_alone(other)) together.push_back(other);
    }
    text += braced("  " + part + ": ", below(together, part));
  }
  return text;
}

}  // namespace

std::string yaml_value(const std::string& value, bool is_list) {
  if (is_list || is_plain(value)) return value;
  std::string quoted = "\"";
  for (const char letter : value) {
    const auto byte = static_cast<unsigned char>(letter);
    if (byte < 0x20) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\x%02x", byte);
      quoted += escape;
    } else {
      if (letter == '"' || letter == '\\') quoted += '\\';
      quoted += letter;
    }
  }
  return quoted + "\"";
}

std::string config_text(const std::vector<ConfigLine>& lines) {
  std::string text;
  std::string done = "\n";
  for (const ConfigLine& line : lines) {
    const std::string part = part_of(line.key);
    if (part == line.key) {
      text += single_line("", line);
    } else if (done.find("\n" + part + "\n") == std::string::npos) {
      done += part + "\n";
      const std::vector<ConfigLine> own = below(lines, part);
      // A map of nothing but comments would have no value.
      const bool has_value = std::any_of(own.begin(), own.end(),
                                         [](const ConfigLine& one) { return !one.value.empty(); });
      text += (has_value ? part + ":\n" : "") + section(own);
    }
  }
  return text;
}

}  // namespace fathom
