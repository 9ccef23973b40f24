#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "fathom/core/input_error.hpp"
#include "fathom/core/options.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/asl_files.hpp"
#include "yaml_root.hpp"

namespace fathom {
namespace {

const char* const kNoDistortion = "none";

class CameraReader {
 public:
  explicit CameraReader(const std::filesystem::path& path) : file_(path.string()) {
    root_ = yaml_root(path);
    if (!root_.IsMap()) throw InputError(file_, "expected the keys of a camera's sensor.yaml");
  }

  Camera read() const {
    CameraModel model;
    const std::vector<double> resolution = numbers("resolution", "[width, height]", 2, 2);
    model.width = side(resolution[0]);
    model.height = side(resolution[1]);
    const std::vector<double> intrinsics = numbers("intrinsics", "[fx, fy, cx, cy]", 4, 4);
    if (!(intrinsics[0] > 0.0 && intrinsics[1] > 0.0)) {
      refuse(root_["intrinsics"], "intrinsics: focal lengths fx, fy must be pixels > 0");
    }
    model.fx = intrinsics[0];
    model.fy = intrinsics[1];
    model.cx = intrinsics[2];
    model.cy = intrinsics[3];
    read_distortion(model);
    read_mounting(model);
    read_mirrored(model);
    try {
      return Camera(model);
    } catch (const InputError& error) {
      throw InputError(file_, error.what());
    }
  }

 private:
  [[noreturn]] void refuse(const YAML::Node& node, const std::string& what) const {
    throw InputError(file_, line_of(node.Mark()), what);
  }

  double number(const YAML::Node& node, const std::string& key) const {
    const auto value = node.IsScalar() ? parse_real(node.Scalar()) : std::nullopt;
    if (!value) refuse(node, key + ": expected a number");
    return *value;
  }

  std::vector<double> numbers(const std::string& key, const std::string& meaning,
                              std::size_t fewest, std::size_t most) const {
    const YAML::Node node = root_[key];
    if (!node) throw InputError(file_, "key " + key + " is missing; expected " + meaning);
    if (!node.IsSequence() || node.size() < fewest || node.size() > most) {
      refuse(node, key + ": expected " + meaning);
    }
    std::vector<double> values;
    for (const YAML::Node& item : node) values.push_back(number(item, key));
    return values;
  }

  int side(double value) const {
    constexpr double kLargest = 100'000;
    if (!(value >= 1.0 && value <= kLargest && value == std::floor(value))) {
      refuse(root_["resolution"], "resolution: expected whole numbers of pixels > 0");
    }
    return static_cast<int>(value);
  }

  void read_distortion(CameraModel& model) const {
    const YAML::Node node = root_["distortion_model"];
    const std::string name = node && node.IsScalar() ? node.Scalar() : kNoDistortion;
    if (name == kNoDistortion) return refuse_unused_coefficients();
    std::vector<std::string> names{kNoDistortion};
    for (const DistortionEntry& entry : distortion_models()) {
      names.push_back(entry.name);
      if (entry.name != name) continue;
      std::vector<std::string> fewest = entry.coefficients;
      fewest.resize(entry.fewest);
      const std::vector<double> values = numbers(
          "distortion_coefficients",
          fewest == entry.coefficients ? entry.list()
                                       : "[" + joined(fewest, ", ") + "] or " + entry.list(),
          entry.fewest, entry.coefficients.size());
      model.distortion_model = entry.model;
      std::ranges::copy(values, model.distortion.begin());
      return;
    }
    refuse(node, "distortion_model: " + in_quotes(name) + " is unknown; expected one of " +
                     joined(names, ", ") + suggestion(name, names));
  }

  void refuse_unused_coefficients() const {
    const YAML::Node unused = root_["distortion_coefficients"];
    for (const YAML::Node& item : unused) {
      if (number(item, "distortion_coefficients") == 0.0) continue;
      refuse(unused,
             "distortion_coefficients: there is no distortion_model to use them; expected "
             "distortion_model: radial-tangential, or []");
    }
  }

  void read_mounting(CameraModel& model) const {
    const YAML::Node mounting = root_["mounting"];
    if (!mounting) return;
    if (!mounting.IsMap()) refuse(mounting, "mounting: expected {x: , y: , yaw: }");
    for (const auto& entry : mounting) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
      double* const field = key == "x"     ? &model.mount_x_m
                            : key == "y"   ? &model.mount_y_m
                            : key == "yaw" ? &model.mount_yaw_rad
                                           : nullptr;
      if (field == nullptr) {
        refuse(entry.first,
               "mounting: " + in_quotes(key) + " is unknown; expected x, y (m) and yaw (rad)");
      }
      *field = number(entry.second, "mounting." + key);
    }
  }

  void read_mirrored(CameraModel& model) const {
    const YAML::Node node = root_["mirrored"];
    if (!node) return;
    const std::string word = node.IsScalar() ? node.Scalar() : "";
    if (word != "true" && word != "false") refuse(node, "mirrored: expected true or false");
    model.is_mirrored = word == "true";
  }

  std::string file_;
  YAML::Node root_;
};

}  // namespace

Camera read_camera_yaml(const std::filesystem::path& path) {
  return CameraReader(path).read();
}

std::string camera_yaml(const CameraModel& model) {
  YAML::Emitter out;
  const auto put = [&out](const char* key) -> YAML::Emitter& {
    return out << YAML::Key << key << YAML::Value;
  };
  const auto put_list = [&](const char* key, const std::vector<double>& values,
                            const char* comment) {
    put(key) << YAML::Flow << YAML::BeginSeq;
    for (const double value : values) out << exact(value);
    out << YAML::EndSeq << YAML::Comment(comment);
  };
  const DistortionEntry& lens = entry_of(model.distortion_model);
  std::vector<double> coefficients(
      model.distortion.begin(),
      model.distortion.begin() + static_cast<std::ptrdiff_t>(lens.coefficients.size()));
  if (!model.has_distortion()) coefficients.clear();
  out << YAML::BeginMap;
  put("sensor_type") << "camera";
  put("camera_model") << "pinhole";
  put("resolution") << YAML::Flow << YAML::BeginSeq << model.width << model.height << YAML::EndSeq;
  put_list("intrinsics", {model.fx, model.fy, model.cx, model.cy}, "fx, fy, cx, cy [px]");
  put("distortion_model") << (model.has_distortion() ? lens.name : kNoDistortion);
  put_list("distortion_coefficients", coefficients, joined(lens.coefficients, ", ").c_str());
  put("mounting") << YAML::Flow << YAML::BeginMap;
  put("x") << exact(model.mount_x_m);
  put("y") << exact(model.mount_y_m);
  put("yaw") << exact(model.mount_yaw_rad) << YAML::EndMap
             << YAML::Comment(
                    "of the camera in the body frame; yaw 0: picture top forward; m, m, rad");
  if (model.is_mirrored) put("mirrored") << true;
  out << YAML::EndMap;
  return out.c_str() + std::string("\n");
}

}  // namespace fathom
