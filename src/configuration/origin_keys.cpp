#include "origin_keys.hpp"

#include "fathom/datasets/data_set.hpp"

namespace fathom {
namespace {

const std::string kDataSetPrefix = "dataset.";
const std::string kOrigin = "origin";

}  // namespace

bool is_origin_key(const std::string& key) {
  return key.starts_with(kDataSetPrefix + kOrigin + ".");
}

void bind_origin(const std::string& data_set, EarthOriginOptions& options, OptionTable& table) {
  if (!find_data_set(data_set).is_graph) table.group(kDataSetPrefix + kOrigin, options);
}

void check_origin(const Settings& settings, const EarthOriginOptions& options) {
  try {
    options.origin();
  } catch (const InputError& error) {
    for (const Setting& setting : settings.all()) {
      if (is_origin_key(setting.key)) refuse(setting, kDataSetPrefix + error.what());
    }
  }
}

}  // namespace fathom
