#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fathom/configuration/study_description.hpp"

namespace fathom {

/// The unit of a swept key: "rad" of `dataset.odometry.sigma_theta_rad`. Empty without one, or
/// where no label is a number.
std::string unit_of(const StudyAxis& axis);

/// "heading (rad)", "sigma theta (rad)" of an axis `sigma_theta_rad`
std::string title_of(const StudyAxis& axis);

/// What stands at the places of a drawn axis: the labels, of files in folders the names alone where
/// no two are the same, and without the words that all begin with.
std::vector<std::string> ticks_of(const StudyAxis& axis);

/// "heading 0.01 rad"
std::string text_of(const StudyAxis& axis, std::size_t place);

}  // namespace fathom
