#include <fstream>
#include <string_view>
#include <system_error>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/import.hpp"
#include "ros2_file.hpp"
#include "ros2_metadata.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

const char* const kExpected =
    "expected a bag of ROS 1 (.bag) or ROS 2 (.db3, .mcap, or its folder), a COLMAP model as text "
    "(a folder with images.txt) or KITTI poses (12 numbers a line)";

bool has_file_ending(const fs::path& folder, const std::string& ending) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ending) return true;
  }
  return false;
}

ImportKind kind_of_folder(const fs::path& folder) {
  if (fs::exists(folder / "images.txt")) return ImportKind::colmap;
  if (fs::exists(folder / "images.bin")) {
    throw InputError(folder.string(),
                     "is a binary COLMAP model; 'colmap model_converter --input_path MODEL "
                     "--output_path TEXT --output_type TXT' makes one of text");
  }
  if (fs::exists(folder / "metadata.yaml") || has_file_ending(folder, ".db3") ||
      has_file_ending(folder, ".mcap")) {
    return ImportKind::ros2_bag;
  }
  throw InputError(folder.string(), std::string("holds nothing to import; ") + kExpected);
}

bool is_kitti(const fs::path& path) {
  constexpr std::size_t kNumbers = 12;
  std::ifstream file(path);
  // Twelve numbers take a few hundred: it may be a large file of one line.
  std::string line(4096, '\0');
  file.getline(line.data(), static_cast<std::streamsize>(line.size()));
  const auto words = split(std::string_view(line.c_str()));
  return words.size() == kNumbers && parse_real(words.front()) && parse_real(words.back());
}

}  // namespace

ImportKind import_kind(const fs::path& source) {
  using namespace std::string_view_literals;
  std::error_code error;
  if (!fs::exists(source, error)) throw InputError(source.string(), "is not there");
  if (fs::is_directory(source, error)) return kind_of_folder(source);
  constexpr std::size_t kLongest = 16;
  std::string begin(kLongest, '\0');
  std::ifstream file(source, std::ios::binary);
  if (!file) throw InputError(source.string(), "cannot be opened");
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  if (begin.starts_with("#ROSBAG V")) return ImportKind::ros1_bag;
  if (begin.starts_with("SQLite format 3\0"sv)) return ImportKind::ros2_bag;
  if (is_mcap(source)) return ImportKind::ros2_bag;
  if (begin.starts_with("\x28\xB5\x2F\xFD"sv)) refuse_compressed(source);
  if (is_kitti(source)) return ImportKind::kitti;
  throw InputError(source.string(), std::string("is of no kind that is imported; ") + kExpected);
}

}  // namespace fathom
