#include <algorithm>
#include <string>
#include <string_view>

#include "fathom/datasets/picture_folder.hpp"

namespace fathom {
namespace {

bool is_digit(char letter) {
  return letter >= '0' && letter <= '9';
}

// The run of digits that begins at `place`, without leading zeros; moves behind it.
std::string_view number_at(const std::string& name, std::size_t& place) {
  const std::size_t begin = place;
  while (place < name.size() && is_digit(name[place])) ++place;
  const std::string_view digits(name.data() + begin, place - begin);
  return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
}

}  // namespace

bool is_before(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view m = number_at(a, i);
      const std::string_view n = number_at(b, j);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
    } else {
      if (a[i] != b[j]) {
        return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
      }
      ++i;
      ++j;
    }
  }
  const bool a_ended = i == a.size();
  const bool b_ended = j == b.size();
  if (a_ended != b_ended) return a_ended;
  return a < b;  // alike but for leading zeros
}

}  // namespace fathom
