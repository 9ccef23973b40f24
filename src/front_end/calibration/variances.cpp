#include <cmath>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "fathom/core/median.hpp"
#include "fathom/core/text.hpp"
#include "findings.hpp"

namespace fathom {
namespace {

// What dead reckoning and registrations tell of a motion, against what is left of it; σ.
struct ToldSigma {
  double reckoned = 0.0;
  double both = 0.0;
};

// Of a number that stands for so many axes.
ToldSigma told_sigma(const CalibrationInput& input, double SeenMotion::*reckoned,
                     double SeenMotion::*seen, double axes) {
  std::vector<double> of_reckoned;
  std::vector<double> of_both;
  for (const SeenMotion& motion : input.motions) {
    if (!(motion.*reckoned > 0.0)) continue;
    of_reckoned.push_back(motion.*reckoned / axes);
    of_both.push_back((motion.*reckoned + motion.*seen) / axes);
  }
  return {std::sqrt(upper_median(of_reckoned)), std::sqrt(upper_median(of_both))};
}

// Rolls that nobody measured, currents and a heading that drifts leave more than is told, and who
// is careful tells more than is left; no vehicle by such factors.
void find_variance(const ToldSigma& told, double left, const char* unit, const char* column,
                   std::vector<std::string>& findings) {
  constexpr double kMostLeft = 300.0;
  constexpr double kMostTold = 20.0;
  constexpr double kMostOfBoth = 3.0;  // of registrations, as far as they know theirs
  if (told.reckoned == 0.0) return;
  const bool is_too_small = left > kMostLeft * told.reckoned && left > kMostOfBoth * told.both;
  if (!is_too_small && told.reckoned < kMostTold * left) return;
  // What registrations do not know of their own errors is left of motions, too.
  const std::string other =
      is_too_small ? ", unless rolls that nobody measured or a slope of the floor are in it" : "";
  findings.push_back(fmt::format(
      "variances of odometry0 are too {}: a motion has σ {} {} by them, and what the pictures "
      "leave "
      "of it is {} {}{}; {} are variances of the motion from one row to the next, in {}²",
      is_too_small ? "small" : "large", short_number(told.reckoned, 2), unit, short_number(left, 2),
      unit, other, column, unit));
}

}  // namespace

void find_variances(const CalibrationInput& input, const SetUp& found,
                    std::vector<std::string>& findings) {
  const ToldSigma metres =
      told_sigma(input, &SeenMotion::reckoned_variance_m2, &SeenMotion::variance_m2, 2.0);
  const ToldSigma radians =
      told_sigma(input, &SeenMotion::reckoned_variance_rad2, &SeenMotion::variance_rad2, 1.0);
  find_variance(metres, found.sigma_m, "m", "step_var_x and step_var_y", findings);
  find_variance(radians, found.sigma_rad, "rad", "values of step_var_theta", findings);
}

}  // namespace fathom
