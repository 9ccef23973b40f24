#include "yaml_root.hpp"

#include <set>
#include <string>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/core/yaml_limits.hpp"

namespace fathom {
namespace {

void require_single_keys(const YAML::Node& node, const std::string& file) {
  if (!node.IsMap()) return;
  std::set<std::string> keys;
  for (const auto& entry : node) {
    if (entry.first.IsScalar() && !keys.insert(entry.first.Scalar()).second) {
      throw InputError(file, line_of(entry.first.Mark()),
                       in_quotes(entry.first.Scalar()) + " is given twice");
    }
    require_single_keys(entry.second, file);
  }
}

}  // namespace

std::size_t line_of(const YAML::Mark& mark) {
  return mark.is_null() ? 1 : static_cast<std::size_t>(mark.line) + 1;
}

YAML::Node yaml_root(const std::filesystem::path& path) {
  const std::string text = read_text(path, kMostYamlBytes);
  require_yaml_within_limits(text, path.string());
  try {
    YAML::Node root = YAML::Load(text);
    require_single_keys(root, path.string());
    return root;
  } catch (const YAML::Exception& error) {
    throw InputError(path.string(), line_of(error.mark), "is not valid YAML: " + error.msg);
  }
}

}  // namespace fathom
