#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "fathom/configuration/config_file.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {

/// The settings of a YAML text, by way of a file called config.yaml.
inline Settings settings_of(const std::string& text) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "config.yaml";
  std::ofstream(path, std::ios::binary) << text;
  return read_settings(path);
}

}  // namespace fathom::test
