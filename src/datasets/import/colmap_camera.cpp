#include "colmap_camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/asl_files.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

// Parameters are the focal lengths, the centre and the coefficients in OpenCV's order.
struct ColmapModel {
  const char* name;
  std::size_t focal_lengths;
  DistortionModel distortion;
  std::size_t coefficients;
};

constexpr auto kColmapModels =
    std::to_array<ColmapModel>({{"SIMPLE_PINHOLE", 1, DistortionModel::radial_tangential, 0},
                                {"PINHOLE", 2, DistortionModel::radial_tangential, 0},
                                {"SIMPLE_RADIAL", 1, DistortionModel::radial_tangential, 1},
                                {"RADIAL", 1, DistortionModel::radial_tangential, 2},
                                {"OPENCV", 2, DistortionModel::radial_tangential, 4},
                                {"FULL_OPENCV", 2, DistortionModel::rational_polynomial, 8},
                                {"SIMPLE_RADIAL_FISHEYE", 1, DistortionModel::equidistant, 1},
                                {"RADIAL_FISHEYE", 1, DistortionModel::equidistant, 2},
                                {"OPENCV_FISHEYE", 2, DistortionModel::equidistant, 4}});

struct ColmapLine {
  std::int64_t id = 0;
  std::string model;
  std::vector<double> numbers;  ///< width, height, parameters
};

// CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]
ColmapLine parse_camera(const std::string& file, const TextLine& line) {
  const auto words = split(line.text.substr(0, kLongestRow));
  ColmapLine camera;
  const auto id = words.empty() ? std::nullopt : parse_integer(words[0]);
  bool is_camera = words.size() > 4 && id;
  for (std::size_t i = 2; is_camera && i < words.size(); ++i) {
    const auto number = parse_real(words[i]);
    is_camera = number.has_value() && (i > 3 || (*number >= 1.0 && *number <= 1e5));
    camera.numbers.push_back(number.value_or(0.0));
  }
  if (!is_camera) {
    throw InputError(file, line.number, "expected CAMERA_ID MODEL WIDTH HEIGHT PARAMS");
  }
  camera.id = *id;
  camera.model = words[1];
  return camera;
}

ColmapLine find_camera(const fs::path& file, std::int64_t id) {
  const std::string text = read_text(file);
  for (const TextLine& line : lines_of(text)) {
    if (line.text.front() == '#') continue;
    ColmapLine camera = parse_camera(file.string(), line);
    if (camera.id == id) return camera;
  }
  throw InputError(file.string(),
                   "has no camera " + std::to_string(id) + ", which images.txt names");
}

// Throws InputError where it is of no model that is read.
CameraModel colmap_camera_of(const ColmapLine& line, const CameraModel& mounting) {
  const auto* const model = std::ranges::find(kColmapModels, line.model, &ColmapModel::name);
  if (model == kColmapModels.end()) {
    throw InputError("camera model " + in_quotes(line.model) + " is not read");
  }
  constexpr std::size_t kBefore = 2;  // width and height
  if (line.numbers.size() != kBefore + model->focal_lengths + 2 + model->coefficients) {
    throw InputError("camera model " + line.model + " does not have " +
                     counted(line.numbers.size() - kBefore, "parameter"));
  }
  CameraModel camera = mounting;
  camera.width = static_cast<int>(line.numbers[0]);
  camera.height = static_cast<int>(line.numbers[1]);
  const auto parameter = line.numbers.begin() + kBefore;
  const auto centre = parameter + static_cast<std::ptrdiff_t>(model->focal_lengths);
  camera.fx = parameter[0];
  camera.fy = *(centre - 1);
  // The corner of the first pixel is COLMAP's origin.
  camera.cx = centre[0] - 0.5;
  camera.cy = centre[1] - 0.5;
  camera.distortion_model = model->distortion;
  camera.distortion.fill(0.0);
  std::copy(centre + 2, line.numbers.end(), camera.distortion.begin());
  return Camera(camera).model();
}

}  // namespace

void write_colmap_camera(const fs::path& model, const std::set<std::int64_t>& used,
                         const CameraModel& mounting, const fs::path& folder,
                         ImportReport& report) {
  const fs::path file = model / "cameras.txt";
  std::error_code error;
  if (!fs::exists(file, error)) return;
  if (used.size() > 1) {
    report.notes.push_back("no sensor.yaml: the images are of " + counted(used.size(), "camera"));
    return;
  }
  const ColmapLine line = find_camera(file, *used.begin());
  try {
    write_file(folder / "sensor.yaml", camera_yaml(colmap_camera_of(line, mounting)));
    report.facts.push_back("sensor.yaml: the camera of the model, " + line.model);
  } catch (const InputError& why) {
    report.notes.push_back(std::string("no sensor.yaml: ") + why.what());
  }
}

}  // namespace fathom
