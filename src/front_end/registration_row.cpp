#include "registration_row.hpp"

#include <cstddef>

#include "fathom/core/hash.hpp"

namespace fathom {

namespace {

// Every number of a registration, in the order of its row.
template <class Value, class Use>
void for_each_number(Value& value, const Use& use) {
  const auto matrix = [&](auto& m) {
    for (int i = 0; i < 9; ++i) use(m(i / 3, i % 3));
  };
  use(value.motion.x);
  use(value.motion.y);
  use(value.motion.theta);
  matrix(value.covariance);
  matrix(value.shared.own);
  for (auto& own : value.own.by_told) matrix(own);
  matrix(value.own.bend_from);
  matrix(value.own.bend_to);
  for (auto* picture : {&value.shared.from, &value.shared.to}) {
    matrix(picture->G);
    for (int i = 0; i < 3; ++i) use(picture->sigma[i]);
  }
}

}  // namespace

RegistrationNumbers numbers_of(const PairRegistration& value) {
  RegistrationNumbers numbers{};
  std::size_t next = 0;
  for_each_number(value, [&](const double& number) { numbers[next++] = number; });
  return numbers;
}

PairRegistration registration_of(bool found, const RegistrationNumbers& numbers, int inliers) {
  PairRegistration value;
  value.found = found;
  value.inliers = inliers;
  std::size_t next = 0;
  for_each_number(value, [&](double& number) { number = numbers[next++]; });
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
