#include "fathom/core/random.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

#include "fathom/core/hash.hpp"

namespace fathom {

std::uint64_t stream_seed(std::uint64_t base_seed, std::string_view stream, std::uint64_t trial) {
  assert(!stream.empty());
  std::uint64_t hash = mix_bits(base_seed);
  for (const char letter : stream) hash = mix_bits(hash ^ static_cast<unsigned char>(letter));
  return mix_bits(hash ^ mix_bits(trial));
}

std::uint64_t survey_seed(std::uint64_t base_seed, std::uint64_t survey) {
  return survey == 0 ? base_seed : stream_seed(base_seed, "survey", survey);
}

double RandomStream::uniform() {
  return static_cast<double>(engine_() >> 11) * 0x1.0p-53;
}

double RandomStream::normal() {
  if (has_spare_normal_) {
    has_spare_normal_ = false;
    return spare_normal_;
  }
  // Box and Muller; 1 − u keeps the logarithm's argument above zero.
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_normal_ = radius * std::sin(angle);
  has_spare_normal_ = true;
  return radius * std::cos(angle);
}

std::uint64_t RandomStream::index(std::uint64_t count) {
  // Rejection sampling: draws past the last whole multiple of count would favour small indices.
  const std::uint64_t limit = std::mt19937_64::max() - std::mt19937_64::max() % count;
  std::uint64_t draw = engine_();
  while (draw >= limit) draw = engine_();
  return draw % count;
}

}  // namespace fathom
