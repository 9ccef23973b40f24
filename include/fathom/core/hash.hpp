#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

namespace fathom {

/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): each input bit reaches each output bit.
constexpr std::uint64_t mix_bits(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

/// A 64-bit hash of a sequence of values, to tell contents apart; not against an adversary. Two
/// hashes with different bases are as good as independent. The same on every run of one machine.
class Hash {
 public:
  explicit Hash(std::uint64_t base = 0) : state_(mix_bits(base)) {}

  Hash& add(std::integral auto value) { return add_word(static_cast<std::uint64_t>(value)); }
  /// The bits of the number: 0.0 and -0.0 differ.
  Hash& add(double value) { return add_word(std::bit_cast<std::uint64_t>(value)); }
  /// Bytes with their number, so that neighbours do not run into each other.
  Hash& add(std::string_view bytes);

  std::uint64_t value() const { return state_; }

 private:
  Hash& add_word(std::uint64_t word) {
    state_ = mix_bits(state_ ^ word);
    return *this;
  }

  std::uint64_t state_;
};

/// FNV-1a, 64 bits, as 16 hexadecimal digits.
std::string hash_text(const std::string& content);

}  // namespace fathom
