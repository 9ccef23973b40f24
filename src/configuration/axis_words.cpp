#include "fathom/configuration/axis_words.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "fathom/core/text.hpp"

namespace fathom {
namespace {

// How keys end; the longer before what they end with.
constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kEndings{{
    {"_per_m", "1/m"},
    {"_m_s", "m/s"},
    {"_rad", "rad"},
    {"_px", "px"},
    {"_hz", "Hz"},
    {"_m", "m"},
    {"_s", "s"},
}};

bool is_number(const std::string& label) {
  return parse_real(label).has_value();
}

// How the key ends and the unit that this means; both empty without one, or where no label is a
// number.
std::pair<std::string_view, std::string_view> ending_of(const StudyAxis& axis) {
  if (std::ranges::none_of(axis.labels, is_number)) return {};
  for (const auto& ending : kEndings) {
    if (axis.key.ends_with(ending.first)) return ending;
  }
  return {};
}

// As words, without the unit of its key.
std::string words_of(const StudyAxis& axis) {
  std::string words = axis.name;
  const std::string_view ending = ending_of(axis).first;
  if (words.ends_with(ending)) words.resize(words.size() - ending.size());
  std::ranges::replace(words, '_', ' ');
  return words;
}

// The words that all begin with, to the last separator. None of a few letters, which take no room.
std::size_t words_alike(const std::vector<std::string>& names) {
  constexpr std::size_t kFew = 6;
  const auto& [first, last] = std::ranges::minmax(names);
  const auto length = std::ranges::mismatch(first, last).in1 - first.begin();
  const std::string alike = first.substr(0, static_cast<std::size_t>(length));
  const std::size_t words = alike.find_last_of("_- .") + 1;
  return words < kFew ? 0 : words;
}

}  // namespace

std::string unit_of(const StudyAxis& axis) {
  return std::string(ending_of(axis).second);
}

std::string title_of(const StudyAxis& axis) {
  const std::string unit = unit_of(axis);
  return words_of(axis) + (unit.empty() ? "" : " (" + unit + ")");
}

std::vector<std::string> ticks_of(const StudyAxis& axis) {
  std::vector<std::string> names;
  names.reserve(axis.labels.size());
  for (const std::string& label : axis.labels) {
    const std::string name = label.substr(label.rfind('/') + 1);
    if (name.empty() || std::ranges::find(names, name) != names.end()) return axis.labels;
    names.push_back(name);
  }
  const std::size_t alike =
      names.size() < 2 || std::ranges::any_of(names, is_number) ? 0 : words_alike(names);
  for (std::string& name : names) {
    if (alike > 0) name = "…" + name.substr(alike);
  }
  return names;
}

std::string text_of(const StudyAxis& axis, std::size_t place) {
  const std::string& label = axis.labels[place];
  const std::string unit = unit_of(axis);
  const bool is_bare = !unit.empty() && is_number(label);
  return words_of(axis) + " " + label + (is_bare ? " " + unit : "");
}

}  // namespace fathom
