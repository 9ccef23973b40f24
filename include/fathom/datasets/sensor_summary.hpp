#pragma once

#include "fathom/datasets/folder_sensors.hpp"
#include "fathom/datasets/folder_summary.hpp"
#include "fathom/datasets/frame_source.hpp"

namespace fathom {

/// What `fathom check DIR` says of compass and fixes; added to the rest.
void sum_up_sensors(const FolderSensors& sensors, FolderSummary& summary);

/// Of the holes in dead reckoning, if there are any.
void sum_up_holes(const FrameSource& source, FolderSummary& summary);

}  // namespace fathom
