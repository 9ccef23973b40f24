#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "fathom/datasets/frame_source.hpp"

namespace fathom {

/// Whether places of the picture that are no floor are masked.
enum class MaskUse {
  automatic,  ///< the data set's mask, else what stays in place in its pictures
  off
};

/// What pictures of a survey say of the floor, and what they do not.
struct PictureUse {
  cv::Mat mask;  ///< CV_8U, of the pictures' size: 0 where they are no floor; empty: nowhere
  bool is_given = false;  ///< by the data set
  bool is_told = true;    ///< false: what stays in place in so many pictures cannot be told
  /// By frame: whether its picture repeats the one before, though the vehicle moved; empty: none.
  std::vector<bool> repeats;

  bool is_repeated(std::size_t frame) const { return frame < repeats.size() && repeats[frame]; }
};

/// Looks at some pictures, spread over the survey, and at the identity of all. What cannot be read
/// is passed over. The same whatever the number of threads.
PictureUse picture_use(const FrameSource& frames, MaskUse use);

/// The frames whose picture is that of the frame before, byte for byte, though the vehicle moved by
/// pixels: by dead reckoning, where there is any. So does a camera that hangs.
std::vector<bool> repeated_pictures(const FrameSource& frames);

/// What is to be said of it, a line each: what is masked and how to switch that off, which pictures
/// repeat the one before.
std::vector<std::string> remarks_on(const PictureUse& use, const FrameSource& frames);

}  // namespace fathom
