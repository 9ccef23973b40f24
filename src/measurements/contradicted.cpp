#include "contradicted.hpp"

#include <algorithm>
#include <cmath>

#include "fathom/core/chi_squared.hpp"

namespace fathom {
namespace {

// A round leaves out what is at least this part as bad as the worst: what is less may be bad by the
// worst's doing, over the poses. It decides the number of rounds alone, not what is bad.
constexpr double kBesides = 4.0;

}  // namespace

std::vector<std::size_t> contradicted(const MeasurementLog& log, const std::vector<double>& chi2,
                                      double level) {
  const auto count = std::ranges::count_if(chi2, [](double x) { return std::isfinite(x); });
  if (!(level > 0.0) || count == 0) return {};
  const double most = chi_squared_quantile(1.0 - level / static_cast<double>(count), 3.0);
  std::vector<double> worst(log.size(), 0.0);  // by picture
  std::vector<std::size_t> found;
  const auto visit = [&](const auto& what) {
    std::size_t i = 0;
    for (std::size_t k = 0; k < log.size(); ++k) {
      for (const RelativePose& z : log.arrival(k).registrations) {
        if (chi2[i] > most) what(i, z);
        ++i;
      }
    }
  };
  visit([&](std::size_t i, const RelativePose& z) {
    worst[z.from] = std::max(worst[z.from], chi2[i]);
    worst[z.to] = std::max(worst[z.to], chi2[i]);
  });
  const double worst_of_all = *std::ranges::max_element(worst);
  visit([&](std::size_t i, const RelativePose& z) {
    if (chi2[i] >= std::max({worst[z.from], worst[z.to], worst_of_all / kBesides}))
      found.push_back(i);
  });
  return found;
}

}  // namespace fathom
