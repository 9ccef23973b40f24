#include "distributions.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace fathom {

double normal_cdf(double z) {
  return cdf(boost::math::normal(), z);
}

double normal_quantile(double probability) {
  return quantile(boost::math::normal(), probability);
}

double student_quantile(double probability, double degrees_of_freedom) {
  return quantile(boost::math::students_t(degrees_of_freedom), probability);
}

double few_values(std::size_t values, double probability) {
  const auto count = static_cast<double>(values);
  const double upper = 0.5 * (1.0 + probability);
  return student_quantile(upper, count - 1.0) / normal_quantile(upper) *
         std::sqrt(count / (count - 1.0));
}

double binomial_upper_bound(std::size_t successes, std::size_t count, double probability) {
  return boost::math::binomial::find_upper_bound_on_p(static_cast<double>(count),
                                                      static_cast<double>(successes), probability);
}

}  // namespace fathom
