#include "fathom/core/chi_squared.hpp"

#include <cmath>
#include <limits>

namespace fathom {
namespace {

// Regularised lower incomplete gamma function P(a, x): the series below a + 1, the continued
// fraction (modified Lentz) above (Abramowitz and Stegun 6.5.29 and 6.5.31).
double gamma_p(double a, double x) {
  if (x <= 0.0) return 0.0;
  const double scale = std::exp(-x + a * std::log(x) - std::lgamma(a));
  constexpr double kPrecision = std::numeric_limits<double>::epsilon();
  if (x < a + 1.0) {
    double term = 1.0 / a;
    double sum = term;
    for (double n = a + 1.0; term > sum * kPrecision; n += 1.0) {
      term *= x / n;
      sum += term;
    }
    return sum * scale;
  }
  constexpr double kTiny = std::numeric_limits<double>::min() / kPrecision;
  double b = x + 1.0 - a;
  double c = 1.0 / kTiny;
  double d = 1.0 / b;
  double fraction = d;
  for (int i = 1; i < 10000; ++i) {
    const double an = -i * (i - a);
    b += 2.0;
    d = an * d + b;
    if (std::abs(d) < kTiny) d = kTiny;
    c = b + an / c;
    if (std::abs(c) < kTiny) c = kTiny;
    d = 1.0 / d;
    fraction *= d * c;
    if (std::abs(d * c - 1.0) <= kPrecision) break;
  }
  return 1.0 - fraction * scale;
}

}  // namespace

double chi_squared_cdf(double x, double degrees_of_freedom) {
  return gamma_p(degrees_of_freedom / 2.0, x / 2.0);
}

double chi_squared_quantile(double probability, double degrees_of_freedom) {
  double high = degrees_of_freedom + 10.0;
  while (chi_squared_cdf(high, degrees_of_freedom) < probability) high *= 2.0;
  double low = 0.0;
  // Bisection to the last bit: it is called once per estimator, and it cannot fail.
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (chi_squared_cdf(middle, degrees_of_freedom) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace fathom
