#pragma once

#include <cstddef>
#include <string>

#include "fathom/configuration/study_description.hpp"

namespace fathom {

/// The unit of a swept key where neither the name of the axis nor its labels say it: "rad" of
/// `dataset.odometry.sigma_theta_rad` with the name "heading". Empty without one.
std::string unit_of(const StudyAxis& axis);

/// "heading (rad)"
std::string title_of(const StudyAxis& axis);

/// "heading 0.01 rad"
std::string text_of(const StudyAxis& axis, std::size_t place);

}  // namespace fathom
