#pragma once

#include <string>
#include <vector>

#include "fathom/datasets/folder_sensors.hpp"
#include "fathom/datasets/frame_source.hpp"

namespace fathom {

/// Takes out headings and fixes that their neighbours contradict by many of their standard
/// deviations: headings as they are and as dead reckoning carries them, fixes by the distances
/// between them, against those of dead reckoning where there is some. Over holes nothing
/// contradicts. Says what it took out, or left in where the sensor's outliers are kept.
std::vector<std::string> leave_out_contradicted(FolderSensors& sensors,
                                                const std::vector<FrameInfo>& frames);

}  // namespace fathom
