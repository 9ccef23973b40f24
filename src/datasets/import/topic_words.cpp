#include "topic_words.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <iterator>

namespace fathom {
namespace {

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}
bool is_capital(char c) {
  return std::isupper(static_cast<unsigned char>(c)) != 0;
}

// In lower case: "dvl" and "altitude" of "/dvl0/bottomAltitude", besides "bottom". Where the last
// of several capitals begins a word, "dvl" and "range" of "/DVLRange"; else "gtpose" of "/GTpose".
Words words_in(const std::string& name, bool last_capital_begins) {
  Words words;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (!is_letter(name[i])) continue;
    const char before = i == 0 ? '/' : name[i - 1];
    const char after = i + 1 == name.size() ? '/' : name[i + 1];
    const bool is_last = last_capital_begins && is_letter(after) && !is_capital(after);
    const bool begins =
        !is_letter(before) || (is_capital(name[i]) && (!is_capital(before) || is_last));
    if (begins) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
  }
  return words;
}

bool is_named(const std::string& word, const std::string& by) {
  return by.ends_with('*') ? word.starts_with(by.substr(0, by.size() - 1)) : word == by;
}

}  // namespace

// Whole ones: /gtsam is no ground truth, and a realtime_factor no altitude.
bool has_word(const std::string& name, const Words& words) {
  Words found = words_in(name, false);
  std::ranges::copy(words_in(name, true), std::back_inserter(found));
  return std::ranges::any_of(found, [&](const std::string& word) {
    return std::ranges::any_of(words, [&](const std::string& by) { return is_named(word, by); });
  });
}

const Words& truth_words() {
  static const Words words{"truth*",     "groundtruth*", "gt",     "gtpose", "gtodom",
                           "gtodometry", "reference",    "mocap*", "vicon*", "optitrack*"};
  return words;
}

const Words& altimeter_words() {
  static const Words words{"alti*"};
  return words;
}

const Words& altitude_words() {
  static const Words words{"alti*", "height", "range", "rangefinder", "dvl"};
  return words;
}

}  // namespace fathom
