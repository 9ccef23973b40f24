#include "architecture/checkout.hpp"

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace fathom::test {

namespace fs = std::filesystem;

std::vector<std::string> files_below(const std::vector<std::string>& folders,
                                     const std::string& name_pattern) {
  const fs::path top = FATHOM_SOURCE_DIR;
  const std::regex pattern(name_pattern);
  std::vector<std::string> files;
  for (const std::string& folder : folders) {
    for (const auto& entry : fs::recursive_directory_iterator(
             top / folder, fs::directory_options::follow_directory_symlink)) {
      if (!std::regex_match(entry.path().filename().string(), pattern)) continue;
      files.push_back(folder + "/" + entry.path().lexically_relative(top / folder).string());
    }
  }
  return files;
}

std::string content_of(const std::string& file) {
  std::ifstream stream(fs::path(FATHOM_SOURCE_DIR) / file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace fathom::test
