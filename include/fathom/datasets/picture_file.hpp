#pragma once

#include <filesystem>
#include <string_view>

#include <opencv2/core.hpp>

namespace fathom {

/// A picture as 8-bit grey, in the rows and columns of the sensor: a rotation tag is ignored. Of 16
/// bits the lower part that nearly all pixels use is spread over 8.
/// Throws InputError naming the file.
cv::Mat read_grey_picture(const std::filesystem::path& path);

/// The same of a file's bytes; the path is for messages.
cv::Mat decode_grey_picture(std::string_view bytes, const std::filesystem::path& path);

/// Writes an 8-bit PNG. Throws InputError naming the file.
void write_png(const std::filesystem::path& path, const cv::Mat& picture);

}  // namespace fathom
