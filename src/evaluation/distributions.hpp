#pragma once

#include <cstddef>

namespace fathom {

/// P(Z ≤ z) of a standard normal variable.
double normal_cdf(double z);

/// The z with P(Z ≤ z) = probability, 0 < probability < 1.
double normal_quantile(double probability);

/// The t with P(T ≤ t) = probability of Student's t, 0 < probability < 1, degrees of freedom > 0.
double student_quantile(double probability, double degrees_of_freedom);

/// By what a bootstrap interval of the mean of so many values is too narrow: it knows no spread but
/// the sample's own, which is too small by √((n − 1) / n), and that spread is itself uncertain. Of
/// normal values the interval is Student's with it (Hesterberg, *What teachers should know about
/// the bootstrap*, 2015).
double few_values(std::size_t count, double probability);

/// The share p at which `successes` or fewer of `count` trials have the given probability;
/// successes < count, 0 < probability < 1.
double binomial_upper_bound(std::size_t successes, std::size_t count, double probability);

}  // namespace fathom
