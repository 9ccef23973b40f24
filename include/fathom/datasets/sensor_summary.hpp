#pragma once

#include "fathom/datasets/folder_sensors.hpp"
#include "fathom/datasets/folder_summary.hpp"
#include "fathom/datasets/frame_source.hpp"

namespace fathom {

/// What `fathom check DIR` says of compass and fixes; added to the rest.
void sum_up_sensors(const FolderSensors& sensors, FolderSummary& summary);

/// Of the holes in dead reckoning, if there are any. `plain` are the same frames without
/// `gap_intervals`, if they can be had so: it warns of holes that these do not have.
void sum_up_holes(const FrameSource& source, const FrameSource* plain, FolderSummary& summary);

}  // namespace fathom
