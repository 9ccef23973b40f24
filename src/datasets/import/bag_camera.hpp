#pragma once

#include <string>

#include "bag_messages.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

/// The camera of the pictures as they are in the bag: K with its distortion, or, for a topic of
/// rectified pictures (a part of its name begins with image_rect), P without; binning and the
/// region of interest applied. Throws InputError on a camera that is not calibrated, on pictures of
/// another size than it says, and on a model other than plumb_bob, and rational_polynomial where it
/// is no more than that.
CameraModel camera_of(const CameraInfoMessage& info, const std::string& image_topic, int width,
                      int height);

bool is_rectified(const std::string& image_topic);

}  // namespace fathom
