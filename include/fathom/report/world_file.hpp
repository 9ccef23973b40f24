#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "fathom/report/earth_frame.hpp"
#include "fathom/report/mosaic.hpp"

namespace fathom {

/// The content of the world file (`.pgw`) of a window of a mosaic: six lines, what the two
/// coordinates gain from column to column, what they gain from row to row, and where the centre of
/// the first pixel lies. Its first coordinate goes to the right of the mosaic and is −y of the map,
/// its second goes up and is x, in metres: so the mosaic stands upright, as many readers need it.
std::string world_file(const MosaicPlan& plan, const cv::Rect& window);

/// The same with easting and northing in the plane of the projection, about the middle of the
/// window, as a world file has no more than six numbers: half a kilometre from there it is off by
/// under a millimetre, 5 km by under 0.1 m.
std::string world_file(const MosaicPlan& plan, const cv::Rect& window, const EarthFrame& earth);

}  // namespace fathom
