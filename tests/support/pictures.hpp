#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "fathom/core/files.hpp"
#include "fathom/vision/picture_codecs.hpp"

namespace fathom::test {

/// Whether it was written, in the format of its ending.
inline bool write_picture(const std::filesystem::path& file, const cv::Mat& picture) {
  const std::string bytes = encode_picture(file.extension().string(), picture);
  if (bytes.empty()) return false;
  std::ofstream out(file, std::ios::binary);
  out << bytes << std::flush;
  return out.good();
}

/// Empty where there is none.
inline cv::Mat read_picture(const std::filesystem::path& file, int flags = cv::IMREAD_COLOR) {
  if (!std::filesystem::exists(file)) return {};
  return decode_picture(read_file(file), flags);
}

}  // namespace fathom::test
