#include "fathom/vision/registration.hpp"

namespace fathom {

void DecisionOptions::describe(OptionTable& table) {
  table.enumeration("method", method,
                    {{"false_alarms", Method::false_alarms}, {"inliers", Method::inliers}},
                    "a motion is found if chance would seldom do so well; or, as the paper, if "
                    "enough matches agree");
  table.real("max_false_alarms", max_false_alarms, Range{1e-300, 1.0}, "",
             "with false_alarms: the chance of so much support, at most");
  table.integer_or_off("first_features", first_features, Range::between(50, 1e6), "features",
                       "with false_alarms: so many of the strongest features are tried first; a "
                       "pair in which chance does as well is given up");
  table.real("first_max_false_alarms", first_max_false_alarms, Range{1e-300, 1.0}, "",
             "the chance of the support of these, at most");
}

void CovarianceOptions::describe(OptionTable& table) {
  table.real_or("altitude_sigma_m", "estimated", altitude_sigma_m, Range::at_least(0.0), "m",
                "standard deviation of an altitude's error, relief included; the altimeter's own "
                "where it states more; estimated by loops where it states none, 0 if they do not");
  table.real_or("tilt_sigma_rad", "estimated", tilt_sigma_rad, Range{0.0, 0.5}, "rad",
                "the same of the camera's roll and of its pitch, where they are not measured; "
                "estimated by loops, 0.005 if they do not tell");
  table.real_or("own_factor", "estimated", own_factor, Range::at_least(1.0), "",
                "of a registration's own sigmas over what its residuals show; likewise, 1");
  table.real("floor_sigma_px", floor_sigma_px, Range::positive(), "pixels",
             "standard deviation added to a registration's x and y, in pixels of the coarser "
             "picture");
  table.real_or_off("floor_sigma_m", floor_sigma_m, Range::positive(), "m",
                    "the same, whatever the altitude");
  table.real("floor_sigma_rad", floor_sigma_rad, Range::positive(), "rad",
             "standard deviation added to a registration's heading");
}

void RegistrationOptions::describe(OptionTable& table) {
  table.group("matching", matching);
  table.group("ransac", ransac);
  table.group("decision", decision);
  table.group("covariance", covariance);
  table.group("registration_tuning", tuning);
}

}  // namespace fathom
