#include "fathom/datasets/picture_file.hpp"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/limits.hpp"
#include "fathom/core/text.hpp"
#include "fathom/vision/picture_codecs.hpp"
#include "picture_header.hpp"

namespace fathom {

namespace {

// OpenCV fills what a cut JPEG lacks with grey and says nothing: it is known by its missing end
// mark. Zeros may follow it, as padding.
bool is_cut_jpeg(std::string_view bytes) {
  using namespace std::string_view_literals;
  const std::string_view content = bytes.substr(0, bytes.find_last_not_of('\0') + 1);
  return bytes.starts_with("\xFF\xD8"sv) && !content.ends_with("\xFF\xD9"sv);
}

cv::Mat decode_sound(std::string_view bytes) {
  constexpr int kFlags = cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION;
  if (is_cut_jpeg(bytes)) return {};
  // Of a damaged PNG the decoder prints, so it gets none.
  if (bytes.starts_with("\x89PNG")) return decode_picture(sound_png(bytes).value_or(""), kFlags);
  return decode_picture(bytes, kFlags);
}

// Before any of it is decoded: a file of some hundred kilobytes can ask for all memory.
void require_pixels(std::string_view bytes, const std::filesystem::path& path) {
  const auto size = size_in_header(bytes);
  const std::uint64_t most = value_of(Limit::picture_pixels);
  if (!size || size->width <= most / std::max<std::uint64_t>(size->height, 1)) return;
  throw InputError(path.string(), fmt::format("has {} x {} pixels in all; {}", size->width,
                                              size->height, limit_text(Limit::picture_pixels)));
}

void require_size(HeaderSize there, cv::Size size, const std::filesystem::path& path,
                  const std::string& expected) {
  if (there.width == static_cast<std::uint64_t>(size.width) &&
      there.height == static_cast<std::uint64_t>(size.height)) {
    return;
  }
  throw InputError(path.string(),
                   fmt::format("has {} x {} pixels, {}", there.width, there.height, expected));
}

// Cameras of 10, 12 or 14 bits fill the lower part of 16: the bits that nearly all pixels have are
// spread over 8, the few above are cut off.
cv::Mat in_eight_bits(const cv::Mat& picture) {
  constexpr double kShare = 0.999;
  std::vector<ushort> greys(picture.begin<ushort>(), picture.end<ushort>());
  const auto rank = static_cast<std::ptrdiff_t>(kShare * static_cast<double>(greys.size() - 1));
  std::nth_element(greys.begin(), greys.begin() + rank, greys.end());
  double range = 256.0;
  while (range <= greys[static_cast<std::size_t>(rank)]) range *= 2.0;
  cv::Mat eight;
  // Rounded it is cut off, and halfway between two greys, where rounding is to even, there is none.
  picture.convertTo(eight, CV_8U, 256.0 / range, 128.0 / range - 0.5);
  return eight;
}

}  // namespace

cv::Mat read_grey_picture(const std::filesystem::path& path) {
  // Decoded from memory: OpenCV prints a warning of its own where it cannot open a file.
  return decode_grey_picture(read_file(path), path);
}

cv::Mat read_grey_picture(const std::filesystem::path& path, cv::Size size,
                          const std::string& expected) {
  const std::string bytes = read_file(path);
  if (const auto told = size_in_header(bytes)) require_size(*told, size, path, expected);
  cv::Mat picture = decode_grey_picture(bytes, path);
  require_size({static_cast<std::uint64_t>(picture.cols), static_cast<std::uint64_t>(picture.rows)},
               size, path, expected);
  return picture;
}

cv::Mat decode_grey_picture(std::string_view bytes, const std::filesystem::path& path) {
  require_pixels(bytes, path);
  cv::Mat picture = decode_sound(bytes);
  if (picture.type() == CV_16U && !picture.empty()) picture = in_eight_bits(picture);
  if (picture.empty() || picture.type() != CV_8U) {
    throw InputError(path.string(),
                     "is no picture that can be read; expected a whole PNG, JPEG, "
                     "TIFF, BMP, PGM or WebP file of 8 or 16 bit");
  }
  return picture;
}

cv::Mat read_mask(const std::filesystem::path& path, cv::Size size) {
  const cv::Mat grey = read_grey_picture(
      path, size,
      fmt::format("the pictures {} x {}; expected a mask of their size, 0 where they are never of "
                  "the floor",
                  size.width, size.height));
  const cv::Mat mask = grey != 0;
  if (cv::countNonZero(mask) == 0) {
    throw InputError(path.string(),
                     "hides all of the picture; expected 0 only where it is never "
                     "of the floor, 255 elsewhere");
  }
  return mask;
}

void write_png(const std::filesystem::path& path, const cv::Mat& picture) {
  const std::string bytes = encode_picture(".png", picture);
  if (bytes.empty()) throw InputError(path.string(), "cannot be encoded as PNG");
  write_file(path, bytes);
}

std::optional<std::string> hidden_pictures_remark(const std::filesystem::path& folder) {
  std::size_t count = 0;
  std::string first;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with('.') || entry.path().extension().empty()) continue;
    if (count == 0 || name < first) first = name;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return folder.string() + ": " + counted(count, "hidden file") + " left out, such as " + first;
}

}  // namespace fathom
