#pragma once

#include <string>
#include <vector>

#include "fathom/configuration/config_file.hpp"
#include "fathom/configuration/study_description.hpp"

namespace fathom {

/// One axis of a sweep: what the study says of it, and the setting that each place stands for.
struct Axis {
  StudyAxis described;
  std::vector<Setting> values;
  std::string prefix;  ///< of its own keys, "sweep.0."
};

/// Whether a key is of the sweep itself.
bool is_sweep_key(const std::string& key);

/// The axes, in order. Throws InputError at the origin of the setting that is wrong.
std::vector<Axis> axes_of(const Settings& settings);

}  // namespace fathom
