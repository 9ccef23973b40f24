#pragma once

#include <opencv2/core.hpp>

#include "fathom/vision/registration_tuning.hpp"

namespace fathom {

/// Every pixel of an 8-bit picture less the mean about it, over the standard deviation there:
/// light, shade and haze that vary slowly are gone, and a faint floor is as rich in contrast as a
/// bold one. Noise of a sensor is blurred first, where there is more of it than of the floor.
cv::Mat flattened(const cv::Mat& gray, const FeatureTuning& tuning);

}  // namespace fathom
