#pragma once

#include <opencv2/core.hpp>

#include "fathom/vision/camera.hpp"
#include "floor_renderer.hpp"

namespace fathom {

/// What a camera makes of the light that comes to its pixels (grey levels): light cone, particles
/// before the lens, contrast, motion blur, colour cast, noise, in this order.
cv::Mat_<float> seen_by_camera(cv::Mat_<float> light, const Camera& camera, const View& view,
                               const PictureEffects& effects);

}  // namespace fathom
