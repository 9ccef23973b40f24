#include "topic_words.hpp"

#include <algorithm>
#include <cctype>

namespace fathom {
namespace {

// In lower case: "dvl" and "altitude" of "/dvl0/bottomAltitude", besides "bottom".
Words words_in(const std::string& name) {
  Words words;
  char before = '/';
  for (const char letter : name) {
    const auto byte = static_cast<unsigned char>(letter);
    const auto last = static_cast<unsigned char>(before);
    if (std::isalpha(byte) != 0) {
      const bool begins =
          std::isalpha(last) == 0 || (std::islower(last) != 0 && std::isupper(byte) != 0);
      if (begins) words.emplace_back();
      words.back() += static_cast<char>(std::tolower(byte));
    }
    before = letter;
  }
  return words;
}

}  // namespace

// Whole ones: /gtsam is no ground truth, and a realtime_factor no altitude.
bool has_word(const std::string& name, const Words& words) {
  return std::ranges::any_of(
      words_in(name), [&](const std::string& word) { return std::ranges::count(words, word) > 0; });
}

const Words& truth_words() {
  static const Words words{"truth", "groundtruth", "gt",       "reference",
                           "mocap", "vicon",       "optitrack"};
  return words;
}

const Words& altimeter_words() {
  static const Words words{"alti", "altitude", "altimeter"};
  return words;
}

const Words& altitude_words() {
  static const Words words{"alti",  "altitude",    "altimeter", "height",
                           "range", "rangefinder", "dvl"};
  return words;
}

}  // namespace fathom
