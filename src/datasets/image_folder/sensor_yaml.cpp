#include "sensor_yaml.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
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

// A standard deviation, below `most`.
double read_sigma(const std::string& file, const YAML::Node& root, const char* key, double most,
                  const char* expected) {
  const YAML::Node node = root[key];
  if (!node) return 0.0;
  const auto value = node.IsScalar() ? parse_real(node.Scalar()) : std::optional<double>();
  if (value && *value >= 0.0 && *value < most) return *value;
  throw InputError(
      file, line_of(node.Mark()),
      fmt::format("{}: {} is no standard deviation; expected {}, or remove the key", key,
                  node.IsScalar() ? in_quotes(node.Scalar()) : "what stands here", expected));
}

// What is read of each sensor, besides what EuRoC's own files say.
const std::map<std::string, std::vector<std::string>>& keys_by_sensor() {
  static const std::map<std::string, std::vector<std::string>> keys{
      {"altimeter0", {"sigma_absolute", "sigma_relative"}},
      {"attitude0", {}},
      {"compass0", {"convention", "mounting"}},
      {"odometry0", {}},
      {"position0", {"mounting"}}};
  return keys;
}

std::string unread_text(const std::string& sensor, const std::string& key) {
  const std::vector<std::string>& known = keys_by_sensor().at(sensor);
  return fmt::format("{} is not read; of {} {}", in_quotes(key), sensor,
                     known.empty() ? "its data.csv alone counts"
                                   : "known are " + joined(known, ", ") + suggestion(key, known));
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
  sensor.sigma_absolute =
      read_sigma(path.string(), root, "sigma_absolute", 1e9, "a number >= 0 in the sensor's unit");
  sensor.sigma_relative = read_sigma(path.string(), root, "sigma_relative", 1.0,
                                     "a share of the reading >= 0 and below 1");
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

std::vector<std::string> unread_sensor_keys(const std::filesystem::path& mav0) {
  static const std::vector<std::string> kEuRoC{"sensor_type", "comment", "T_BS", "rate_hz"};
  std::vector<std::string> lines;
  for (const auto& [sensor, known] : keys_by_sensor()) {
    const std::filesystem::path path = mav0 / sensor / "sensor.yaml";
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) continue;
    YAML::Node root;
    try {
      root = root_of(path);
    } catch (const InputError& fault) {
      // Where something is read of it, its reader has refused it.
      lines.push_back(std::string(fault.what()) + "; nothing is read of it");
      continue;
    }
    if (!root.IsMap()) continue;
    for (const auto& entry : root) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
      const auto has = [&key](const auto& keys) {
        return std::ranges::find(keys, key) != keys.end();
      };
      if (has(kEuRoC) || has(known)) continue;
      lines.push_back(fmt::format("{}:{}: {}", path.string(), line_of(entry.first.Mark()),
                                  unread_text(sensor, key)));
    }
  }
  return lines;
}

}  // namespace fathom
