#include "sensor_yaml.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <system_error>
#include <utility>

#include "fathom/core/input_error.hpp"
#include "fathom/core/options.hpp"
#include "fathom/core/text.hpp"
#include "yaml_root.hpp"

namespace fathom {
namespace {

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

// A number that `is_right`; without the key the fallback.
template <class Test>
double read_number(const std::string& file, const YAML::Node& root, const char* key,
                   double fallback, Test is_right, const char* what, const char* expected) {
  const YAML::Node node = root[key];
  if (!node) return fallback;
  const auto value = node.IsScalar() ? parse_real(node.Scalar()) : std::optional<double>();
  if (value && is_right(*value)) return *value;
  throw InputError(
      file, line_of(node.Mark()),
      fmt::format("{}: {} is no {}; expected {}, or remove the key", key,
                  node.IsScalar() ? in_quotes(node.Scalar()) : "what stands here", what, expected));
}

// One of the words, which stand for what is beside them; without the key the first.
template <class Value>
Value read_word(const std::string& file, const YAML::Node& root, const char* key,
                const std::vector<std::pair<std::string, Value>>& words) {
  const YAML::Node node = root[key];
  if (!node) return words.front().second;
  const std::string name = node.IsScalar() ? node.Scalar() : "";
  std::vector<std::string> names;
  for (const auto& [word, value] : words) {
    if (word == name) return value;
    names.push_back(word);
  }
  throw InputError(file, line_of(node.Mark()),
                   fmt::format("{}: {} is unknown; expected {}{}", key, in_quotes(name),
                               joined(names, " or "), suggestion(name, names)));
}

void read_odometry(const std::string& file, const YAML::Node& root, SensorYaml& sensor) {
  sensor.odometry.convention = read_word(file, root, "convention", odometry_conventions());
  sensor.odometry.is_in_degrees =
      read_word<bool>(file, root, "heading_unit", {{"radians", false}, {"degrees", true}});
  sensor.odometry.scale = sensor.scale;
}

// What is read of each sensor, besides what EuRoC's own files say.
const std::map<std::string, std::vector<std::string>>& keys_by_sensor() {
  static const std::map<std::string, std::vector<std::string>> keys{
      {"altimeter0", {"outliers", "scale", "sigma_absolute", "sigma_relative", "time_offset_s"}},
      {"cam0",
       {"camera_model", "distortion_coefficients", "distortion_model", "intrinsics", "mirrored",
        "mounting", "resolution"}},
      {"attitude0", {"outliers", "time_offset_s"}},
      {"compass0", {"convention", "mounting", "outliers", "time_offset_s"}},
      {"odometry0", {"convention", "heading_unit", "outliers", "scale", "time_offset_s"}},
      {"position0", {"mounting", "outliers", "time_offset_s"}},
      {"state_groundtruth_estimate0", {"time_offset_s"}}};
  return keys;
}

// EuRoC's 4 x 4 matrix, {cols: , rows: , data: [...]}, or the numbers alone.
bool is_identity(const YAML::Node& matrix) {
  const YAML::Node data = matrix.IsMap() ? matrix["data"] : matrix;
  if (!data || !data.IsSequence()) return false;
  constexpr std::size_t kRow = 5;  // from one place of the diagonal to the next
  for (std::size_t i = 0; i < data.size(); ++i) {
    const auto number = data[i].IsScalar() ? parse_real(data[i].Scalar()) : std::optional<double>();
    if (number != std::optional(i % kRow == 0 ? 1.0 : 0.0)) return false;
  }
  return true;
}

std::string unread_text(const std::string& sensor, const std::string& key) {
  const std::vector<std::string>& known = keys_by_sensor().at(sensor);
  return fmt::format("{} is not read; of {} known are {}{}", in_quotes(key), sensor,
                     joined(known, ", "), suggestion(key, known));
}

}  // namespace

SensorYaml read_sensor_yaml(const std::filesystem::path& path) {
  SensorYaml sensor;
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return sensor;
  const YAML::Node root = yaml_root(path);
  if (root.IsNull()) return sensor;
  if (!root.IsMap()) throw InputError(path.string(), "expected the keys of a sensor.yaml");
  if (const YAML::Node mounting = root["mounting"]) read_mounting(path.string(), mounting, sensor);
  const std::string file = path.string();
  const auto is_sigma = [](double most) {
    return [most](double value) { return value >= 0.0 && value < most; };
  };
  sensor.sigma_absolute = read_number(file, root, "sigma_absolute", 0.0, is_sigma(1e9),
                                      "standard deviation", "a number >= 0 in the sensor's unit");
  sensor.sigma_relative =
      read_number(file, root, "sigma_relative", 0.0, is_sigma(1.0), "standard deviation",
                  "a share of the reading >= 0 and below 1");
  sensor.scale = read_number(
      file, root, "scale", 1.0, [](double value) { return value > 1e-6 && value < 1e6; }, "factor",
      "a number > 0 that makes its readings metres");
  constexpr double kDayS = 86400.0;
  constexpr double kNs = 1e9;
  sensor.time_offset_ns =
      std::llround(kNs * read_number(
                             file, root, "time_offset_s", 0.0,
                             [](double value) { return std::abs(value) <= kDayS; }, "time",
                             "seconds to add to its time stamps, at most a day"));
  sensor.keeps_outliers =
      read_word<bool>(file, root, "outliers", {{"leave_out", false}, {"keep", true}});
  if (path.parent_path().filename() == "odometry0") {
    read_odometry(file, root, sensor);
  } else {
    sensor.is_from_north =
        read_word<bool>(file, root, "convention",
                        {{"counter_clockwise_from_x", false}, {"clockwise_from_north", true}});
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
    const YAML::Node root = yaml_root(path);
    if (!root.IsMap()) continue;
    for (const auto& entry : root) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
      const auto has = [&key](const auto& keys) {
        return std::ranges::find(keys, key) != keys.end();
      };
      if (has(kEuRoC) || has(known)) {
        if (sensor == "cam0" && key == "T_BS" && !root["mounting"] && !is_identity(entry.second)) {
          lines.push_back(
              fmt::format("{}:{}: T_BS is not read: the camera is taken to be at the "
                          "body's origin; mounting: {{x: , y: , yaw: }} says where it is",
                          path.string(), line_of(entry.first.Mark())));
        }
        continue;
      }
      lines.push_back(fmt::format("{}:{}: {}", path.string(), line_of(entry.first.Mark()),
                                  unread_text(sensor, key)));
    }
  }
  return lines;
}

}  // namespace fathom
