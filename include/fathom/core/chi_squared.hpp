#pragma once

namespace fathom {

/// P(X ≤ x) of a χ² variable with `degrees_of_freedom` > 0.
double chi_squared_cdf(double x, double degrees_of_freedom);

/// The x with P(X ≤ x) = probability, 0 < probability < 1.
double chi_squared_quantile(double probability, double degrees_of_freedom);

}  // namespace fathom
