// yaml-cpp is for this file alone: the metadata of a ROS 2 bag are YAML.

#include "ros2_metadata.hpp"

#include <algorithm>
#include <string>

#include <yaml-cpp/yaml.h>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/core/yaml_limits.hpp"
#include "fathom/datasets/picture_folder.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

const std::string kConversion =
    "'ros2 bag convert -i BAG -o out.yaml' with out.yaml saying \"output_bags: [{uri: converted, "
    "storage_id: sqlite3, all: true}]\" makes one that is read";

std::string word(const YAML::Node& info, const char* key) {
  const YAML::Node node = info[key];
  return node && node.IsScalar() ? node.Scalar() : "";
}

std::vector<fs::path> named_files(const fs::path& folder, const fs::path& metadata) {
  const std::string text = read_text(metadata, kMostYamlBytes);
  require_yaml_within_limits(text, metadata.string());
  const YAML::Node root = YAML::Load(text);
  const YAML::Node info = root.IsMap() ? root["rosbag2_bagfile_information"] : YAML::Node();
  if (!info || !info.IsMap()) {
    throw InputError(metadata.string(), "has no rosbag2_bagfile_information");
  }
  const std::string storage = word(info, "storage_identifier");
  if (storage != "sqlite3" && storage != "mcap") {
    throw InputError(metadata.string(), "storage_identifier: " + in_quotes(storage) +
                                            " is not read, expected sqlite3 or mcap; " +
                                            kConversion);
  }
  if (!word(info, "compression_format").empty()) refuse_compressed(folder);
  std::vector<fs::path> files;
  for (const YAML::Node& file : info["relative_file_paths"]) {
    // Early versions wrote the bag's own folder before the name.
    files.push_back(folder / fs::path(file.Scalar()).filename());
    if (!fs::is_regular_file(files.back())) {
      throw InputError(metadata.string(),
                       "names " + in_quotes(file.Scalar()) + ", which is not in the folder");
    }
  }
  if (files.empty()) throw InputError(metadata.string(), "names no file of messages");
  return files;
}

std::vector<fs::path> all_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path ending = entry.path().extension();
    if (ending == ".db3" || ending == ".mcap") files.push_back(entry.path());
  }
  // bag_10 comes after bag_9.
  std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
    return is_before(a.filename().string(), b.filename().string());
  });
  if (files.empty()) throw InputError(folder.string(), "has no .db3 or .mcap file of a ROS 2 bag");
  return files;
}

}  // namespace

void refuse_compressed(const fs::path& path, const std::string& what) {
  throw InputError(path.string(), what + "; " + kConversion);
}

std::vector<fs::path> ros2_files(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  const fs::path metadata = path / "metadata.yaml";
  if (!fs::exists(metadata)) return all_files(path);
  try {
    return named_files(path, metadata);
  } catch (const YAML::Exception& error) {
    throw InputError(metadata.string(), "is no metadata of a ROS 2 bag: " + error.msg);
  }
}

}  // namespace fathom
