#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

namespace fathom {

/// What the module of codecs has.
struct PictureCodecs {
  cv::Mat (*decode)(std::string_view bytes, int flags);
  std::string (*encode)(const std::string& ending, const cv::Mat& picture,
                        const std::vector<int>& parameters);
};

/// The name of its PictureCodecs there.
inline constexpr const char* kPictureCodecs = "fathom_picture_codecs";

}  // namespace fathom
