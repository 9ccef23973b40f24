#include "fathom/core/chi_squared.hpp"

#include <boost/math/distributions/chi_squared.hpp>

namespace fathom {
namespace {

using namespace boost::math::policies;
// Out of its domain a NaN, not an exception.
using NaNs = policy<domain_error<ignore_error>, overflow_error<ignore_error>,
                    evaluation_error<ignore_error>>;
using ChiSquared = boost::math::chi_squared_distribution<double, NaNs>;

}  // namespace

double chi_squared_cdf(double x, double degrees_of_freedom) {
  return x <= 0.0 ? 0.0 : cdf(ChiSquared(degrees_of_freedom), x);
}

double chi_squared_quantile(double probability, double degrees_of_freedom) {
  return quantile(ChiSquared(degrees_of_freedom), probability);
}

}  // namespace fathom
