#pragma once

#include <cstddef>

namespace fathom {

/// P(Z ≤ z) of a standard normal variable.
double normal_cdf(double z);

/// The z with P(Z ≤ z) = probability, 0 < probability < 1.
double normal_quantile(double probability);

/// The t with P(T ≤ t) = probability of Student's t, 0 < probability < 1, degrees of freedom > 0.
double student_quantile(double probability, double degrees_of_freedom);

/// The share p at which `successes` or fewer of `count` trials have the given probability;
/// successes < count, 0 < probability < 1.
double binomial_upper_bound(std::size_t successes, std::size_t count, double probability);

}  // namespace fathom
