#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <opencv2/core.hpp>

namespace fathom {

/// A picture as 8-bit grey, in the rows and columns of the sensor: a rotation tag is ignored. Of 16
/// bits the lower part that nearly all pixels use is spread over 8.
/// Throws InputError naming the file, also on more than Limit::picture_pixels, which are not
/// decoded.
cv::Mat read_grey_picture(const std::filesystem::path& path);

/// The same where the size is known. A picture of another is refused by its header, before it is
/// decoded, as "FILE: has W x H pixels, " and `expected`.
cv::Mat read_grey_picture(const std::filesystem::path& path, cv::Size size,
                          const std::string& expected);

/// The same of a file's bytes; the path is for messages.
cv::Mat decode_grey_picture(std::string_view bytes, const std::filesystem::path& path);

/// A mask of pictures of this size: 0 where they are never of the floor. Throws InputError naming
/// the file where it is of another size, or hides all.
cv::Mat read_mask(const std::filesystem::path& path, cv::Size size);

/// Says how many files of a folder are hidden (their names begin with a point, as what desktops
/// leave beside pictures) and so are no pictures, if there are any.
std::optional<std::string> hidden_pictures_remark(const std::filesystem::path& folder);

/// Writes an 8-bit PNG. Throws InputError naming the file.
void write_png(const std::filesystem::path& path, const cv::Mat& picture);

}  // namespace fathom
