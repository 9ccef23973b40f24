#pragma once

#include <cstdint>
#include <cstring>

#include "fathom/core/hash.hpp"
#include "fathom/core/random.hpp"
#include "fathom/front_end/registration_cache.hpp"
#include "support/planar.hpp"

/// Keys and values to fill a store of registrations with.
namespace fathom::test {

inline PairRegistration random_registration(RandomStream& random) {
  return {random.uniform() < 0.8, random_pose(random), random_covariance(random, 1e-4),
          static_cast<int>(random.index(500))};
}

inline RegistrationKey key(std::uint64_t i) {
  return {mix_bits(i), mix_bits(~i)};
}

inline bool same_bits(const PairRegistration& a, const PairRegistration& b) {
  return a.found == b.found && a.inliers == b.inliers &&
         std::memcmp(&a.motion, &b.motion, sizeof a.motion) == 0 &&
         std::memcmp(a.covariance.data(), b.covariance.data(), 9 * sizeof(double)) == 0;
}

}  // namespace fathom::test
