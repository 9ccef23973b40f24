#include "registration_row.hpp"

#include <cstddef>

#include "fathom/core/hash.hpp"

namespace fathom {

RegistrationNumbers numbers_of(const PairRegistration& value) {
  RegistrationNumbers numbers{value.motion.x, value.motion.y, value.motion.theta};
  for (int i = 0; i < 9; ++i) {
    numbers[3 + static_cast<std::size_t>(i)] = value.covariance(i / 3, i % 3);
  }
  return numbers;
}

PairRegistration registration_of(bool found, const RegistrationNumbers& numbers, int inliers) {
  PairRegistration value{found, {numbers[0], numbers[1], numbers[2]}, {}, inliers};
  for (int i = 0; i < 9; ++i) {
    value.covariance(i / 3, i % 3) = numbers[3 + static_cast<std::size_t>(i)];
  }
  return value;
}

std::array<std::uint64_t, 2> words_of(const RegistrationKey& key) {
  return {key.first, key.second};
}

std::int64_t checksum(const RegistrationKey& key, const PairRegistration& value) {
  Hash hash;
  hash.add(key.first).add(key.second).add(value.found).add(value.inliers);
  for (const double number : numbers_of(value)) hash.add(number);
  return static_cast<std::int64_t>(hash.value());
}

}  // namespace fathom
