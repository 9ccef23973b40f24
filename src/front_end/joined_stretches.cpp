#include "fathom/front_end/joined_stretches.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fathom/geometry/trajectory.hpp"

namespace fathom {

void JoinedStretches::extend(std::size_t count, std::span<const std::size_t> holes) {
  for (std::size_t k = stretch_of_.size(); k < count; ++k) {
    const bool is_parted = std::ranges::binary_search(holes, k);
    if (k == 0 || is_parted) {
      groups_.push_back(groups_.size());
      if (k > 0) ++apart_;
    }
    stretch_of_.push_back(groups_.size() - 1);
  }
}

void JoinedStretches::join(std::size_t a, std::size_t b) {
  const auto [first, other] = std::minmax({group(a), group(b)});
  if (first == other) return;
  std::ranges::replace(groups_, other, first);
  --apart_;
}

namespace {

// Turns go on by a step a of s. A place that moves by −1, 0 or 1 a turn has it within s turns if
// a − 1, a and a + 1 share no divisor with s, which can be where 2 and 3 do not divide it. The
// golden section of s has turns that follow each other far apart.
std::size_t step_of(std::size_t s) {
  const double golden = 0.5 * (3.0 - std::sqrt(5.0));
  auto a = static_cast<std::size_t>(std::ceil(golden * static_cast<double>(s)));
  while (std::gcd(a - 1, s) != 1 || std::gcd(a, s) != 1 || std::gcd(a + 1, s) != 1) ++a;
  return a;
}

}  // namespace

std::vector<std::size_t> in_turn(std::size_t count, std::size_t most, std::size_t turn) {
  if (count <= most) return consecutive(0, count);
  if (most == 0) return {};
  std::size_t s = (count + most - 1) / most;
  while (s % 2 == 0 || s % 3 == 0) ++s;
  // Of s neighbours so many, as long as `most` allows it.
  const std::size_t neighbours = most / ((count + s - 1) / s);
  const std::size_t begin = turn % s * step_of(s) % s;
  std::vector<std::size_t> places;
  for (std::size_t place = 0; place < count; ++place) {
    if ((place + s - begin) % s < neighbours) places.push_back(place);
  }
  return places;
}

}  // namespace fathom
