#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "decoded_pictures.hpp"
#include "fathom/report/mosaic.hpp"

namespace fathom {

/// The factors by which each picture of a mosaic is to be multiplied: CV_32F of a picture's size.
/// Learnt from up to 40 of the pictures that are laid. Throws InputError where one cannot be read.
cv::Mat learnt_gain(const Camera& camera, DecodedPictures& decoded,
                    const std::vector<PlacedPicture>& pictures);

/// The picture of a frame, CV_32F, with the illumination taken out.
cv::Mat lit_evenly(const cv::Mat& picture, const cv::Mat& gain);

}  // namespace fathom
