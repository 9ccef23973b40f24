#include "fathom/evaluation/proportion.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>

#include "distributions.hpp"
#include "fathom/core/chi_squared.hpp"
#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

void require_share(std::size_t successes, std::size_t count, double probability) {
  if (successes > count) {
    throw InputError(
        fmt::format("a share needs no more successes than trials, got {} of {}", successes, count));
  }
  if (!(probability > 0.0 && probability < 1.0)) {
    throw InputError("a probability must be above 0 and below 1, got " +
                     std::to_string(probability));
  }
}

}  // namespace

Interval wilson_interval(std::size_t successes, std::size_t count, double probability) {
  require_share(successes, count, probability);
  if (count == 0) return {0.0, 1.0};
  const auto n = static_cast<double>(count);
  const double share = static_cast<double>(successes) / n;
  // χ² of one degree of freedom is the square of a standard normal variable.
  const double z2 = chi_squared_quantile(probability, 1.0);
  const double middle = (share + z2 / (2.0 * n)) / (1.0 + z2 / n);
  const double half =
      std::sqrt(z2 * (share * (1.0 - share) / n + z2 / (4.0 * n * n))) / (1.0 + z2 / n);
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

double clopper_pearson_upper(std::size_t successes, std::size_t count, double probability) {
  require_share(successes, count, probability);
  if (successes == count) return 1.0;
  return binomial_upper_bound(successes, count, 1.0 - probability);
}

}  // namespace fathom
