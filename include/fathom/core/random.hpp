#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace fathom {

/// The seed of one noise stream: a hash of the base seed, the stream's name and the trial, so that
/// no stream's draws depend on how many another one takes. The name must not be empty (asserted):
/// it keeps base seed and trial apart.
std::uint64_t stream_seed(std::uint64_t base_seed, std::string_view stream, std::uint64_t trial);

/// The seed of one survey of a study: of all that is drawn once for its trials. Survey 0 has the
/// base seed itself, so that a study of one survey is what a single run with that seed sees.
std::uint64_t survey_seed(std::uint64_t base_seed, std::uint64_t survey);

/// A noise stream. Same seed, same numbers, whatever the standard library.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed) : engine_(seed) {}
  RandomStream(std::uint64_t base_seed, std::string_view stream, std::uint64_t trial = 0)
      : engine_(stream_seed(base_seed, stream, trial)) {}

  /// Uniform in [0, 1).
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Standard normal.
  double normal();

  /// Uniform in {0, …, count − 1}, without modulo bias; count > 0.
  std::uint64_t index(std::uint64_t count);

 private:
  std::mt19937_64 engine_;
  double spare_normal_ = 0.0;
  bool has_spare_normal_ = false;
};

}  // namespace fathom
