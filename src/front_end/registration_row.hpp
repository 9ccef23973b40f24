#pragma once

#include <array>
#include <cstdint>

#include "fathom/front_end/registration_cache.hpp"

namespace fathom {

/// x, y, θ, the covariance, then the parts of it: own, own by what is told and bends, G and σ of
/// `from`, of `to`; matrices row by row (m, rad), as they lie in a row of the file.
using RegistrationNumbers = std::array<double, 99>;

RegistrationNumbers numbers_of(const PairRegistration& value);

/// A registration from the columns of its row.
PairRegistration registration_of(bool found, const RegistrationNumbers& numbers, int inliers);

/// The key as it lies in a row.
std::array<std::uint64_t, 2> words_of(const RegistrationKey& key);

/// Of a whole row. SQLite does not see a flipped bit in a row; this does.
std::int64_t checksum(const RegistrationKey& key, const PairRegistration& value);

}  // namespace fathom
