#include "sensor_yaml.hpp"

#include <system_error>

#include <yaml-cpp/yaml.h>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/options.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

std::size_t line_of(const YAML::Mark& mark) {
  return mark.is_null() ? 1 : static_cast<std::size_t>(mark.line) + 1;
}

YAML::Node root_of(const std::filesystem::path& path) {
  try {
    return YAML::Load(read_text(path));
  } catch (const YAML::Exception& error) {
    throw InputError(path.string(), line_of(error.mark), "is not valid YAML: " + error.msg);
  }
}

void read_mounting(const std::string& file, const YAML::Node& mounting, SensorYaml& sensor) {
  const auto refuse = [&file](const YAML::Node& node, const std::string& what) {
    throw InputError(file, line_of(node.Mark()), what);
  };
  if (!mounting.IsMap()) refuse(mounting, "mounting: expected {x: , y: , yaw: }");
  for (const auto& entry : mounting) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
    double* const field = key == "x"     ? &sensor.mount_x_m
                          : key == "y"   ? &sensor.mount_y_m
                          : key == "yaw" ? &sensor.mount_yaw_rad
                                         : nullptr;
    if (field == nullptr) {
      refuse(entry.first,
             "mounting: " + in_quotes(key) + " is unknown; expected x, y (m) and yaw (rad)");
    }
    const auto value =
        entry.second.IsScalar() ? parse_real(entry.second.Scalar()) : std::optional<double>();
    if (!value) refuse(entry.second, "mounting." + key + ": expected a number");
    *field = *value;
  }
}

}  // namespace

SensorYaml read_sensor_yaml(const std::filesystem::path& path) {
  SensorYaml sensor;
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return sensor;
  const YAML::Node root = root_of(path);
  if (root.IsNull()) return sensor;
  if (!root.IsMap()) throw InputError(path.string(), "expected the keys of a sensor.yaml");
  if (const YAML::Node mounting = root["mounting"]) read_mounting(path.string(), mounting, sensor);
  const YAML::Node convention = root["convention"];
  if (!convention) return sensor;
  const std::string name = convention.IsScalar() ? convention.Scalar() : "";
  sensor.is_from_north = name == "clockwise_from_north";
  if (!sensor.is_from_north && name != "counter_clockwise_from_x") {
    throw InputError(path.string(), line_of(convention.Mark()),
                     "convention: " + in_quotes(name) +
                         " is unknown; expected counter_clockwise_from_x or clockwise_from_north" +
                         suggestion(name, {"counter_clockwise_from_x", "clockwise_from_north"}));
  }
  return sensor;
}

}  // namespace fathom
