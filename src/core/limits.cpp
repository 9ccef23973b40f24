#include "fathom/core/limits.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

constexpr const char* kVariable = "FATHOM_LIMITS";
// The limit of OpenCV's decoders.
constexpr std::uint64_t kOpenCvPixels = 1U << 30U;

struct NamedLimit {
  std::string_view name;
  std::uint64_t value;
  std::uint64_t most = 1ULL << 62U;
};

using NamedLimits = std::array<NamedLimit, 3>;

NamedLimits limits_of(std::string_view given) {
  NamedLimits limits{{{"csv_rows", 10'000'000},
                      {"picture_pixels", 1U << 28U, kOpenCvPixels},
                      {"chunk_bytes", 128'000'000}}};
  for (const std::string_view word : split(given, ",")) {
    const std::size_t equals = std::min(word.find('='), word.size());
    auto* const limit = std::ranges::find(limits, word.substr(0, equals), &NamedLimit::name);
    const auto value = parse_integer(word.substr(std::min(equals + 1, word.size())));
    if (limit == limits.end() || !value || *value < 1) {
      throw InputError(kVariable, "expected csv_rows=N, picture_pixels=N or chunk_bytes=N, got " +
                                      in_quotes(word));
    }
    limit->value = static_cast<std::uint64_t>(*value);
    if (limit->value > limit->most) {
      throw InputError(kVariable, std::string(limit->name) + ": expected at most " +
                                      std::to_string(limit->most) + ", got " + in_quotes(word));
    }
  }
  return limits;
}

const NamedLimit& in_force(Limit limit) {
  const char* const given = std::getenv(kVariable);
  static const NamedLimits limits = limits_of(given == nullptr ? "" : given);
  return limits.at(static_cast<std::size_t>(limit));
}

}  // namespace

std::uint64_t value_of(Limit limit) {
  return in_force(limit).value;
}

std::string limit_text(Limit limit) {
  const NamedLimit& named = in_force(limit);
  return "the limit is " + std::to_string(named.value) + "; " + kVariable + "=" +
         std::string(named.name) + "=N sets another";
}

}  // namespace fathom
