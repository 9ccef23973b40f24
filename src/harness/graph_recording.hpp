#pragma once

#include <string>

#include "fathom/datasets/data_set.hpp"
#include "fathom/harness/recording.hpp"

namespace fathom {

/// A pose graph as a recording, with vertex ids as whole seconds. Throws InputError where F is not
/// finite, or an id no time.
Recording graph_recording(MeasurementLog log, const std::string& file);

/// The same of measurements that a trial draws.
Recording drawn_recording(DrawnGraph drawn);

}  // namespace fathom
