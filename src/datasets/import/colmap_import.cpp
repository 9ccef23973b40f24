#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <sstream>
#include <string>

#include <Eigen/Geometry>

#include "colmap_camera.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/import.hpp"
#include "fathom/datasets/picture_folder.hpp"
#include "pose_table.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

struct NamedCamera {
  std::string name;
  CameraPose pose;
  std::int64_t camera_id = 0;
};

// IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME; the pose is that of the world in the
// camera.
NamedCamera parse_image(const std::string& file, std::size_t line, std::string_view text) {
  constexpr std::size_t kNumbers = 9;
  constexpr double kMostOff = 0.02;
  const auto words = split(text.substr(0, kLongestRow));
  std::array<double, kNumbers> numbers{};
  bool is_image = words.size() > kNumbers;
  for (std::size_t i = 0; is_image && i < kNumbers; ++i) {
    const auto number = parse_real(words[i]);
    is_image = number.has_value();
    if (number) numbers[i] = *number;
  }
  const auto camera_id = is_image ? parse_integer(words[kNumbers - 1]) : std::nullopt;
  Eigen::Quaterniond rotation(numbers[1], numbers[2], numbers[3], numbers[4]);
  if (!camera_id || std::abs(rotation.norm() - 1.0) > kMostOff) {
    throw InputError(file, line,
                     "expected IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, the quaternion of "
                     "length 1, and a line of points after each");
  }
  NamedCamera camera;
  camera.camera_id = *camera_id;
  camera.pose.axes = rotation.normalized().toRotationMatrix().transpose();
  camera.pose.centre = -camera.pose.axes * Eigen::Vector3d(numbers[5], numbers[6], numbers[7]);
  // A name may have blanks in it.
  camera.name = std::string(trim({words[kNumbers].data(), text.data() + text.size()}));
  return camera;
}

// In the order of their names, as plain pictures are, which is that of the recording as a rule.
std::vector<NamedCamera> read_images(const fs::path& path) {
  std::istringstream lines(read_text(path));
  std::vector<NamedCamera> cameras;
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::string_view text = trim(line);
    if (text.empty() || text.front() == '#') continue;
    cameras.push_back(parse_image(path.string(), number, text));
    // Its points, of which there may be none.
    std::getline(lines, line);
    ++number;
  }
  if (cameras.empty()) throw InputError(path.string(), "has no images");
  std::ranges::sort(cameras, [](const NamedCamera& a, const NamedCamera& b) {
    return is_before(a.name, b.name);
  });
  return cameras;
}

/// The pictures of a survey by their names.
class Survey {
 public:
  Survey(const fs::path& path, std::vector<std::string>& notes)
      : folder_(open_pictures_of(path, notes)) {
    for (std::size_t i = 0; i < folder_->size(); ++i) frames_[folder_->picture_name(i)] = i;
  }

  const FrameSource& folder() const { return *folder_; }

  std::optional<std::size_t> frame(const std::string& name) const {
    const auto found = frames_.find(fs::path(name).filename().string());
    if (found == frames_.end()) return std::nullopt;
    return found->second;
  }

 private:
  std::unique_ptr<const FrameSource> folder_;
  std::map<std::string, std::size_t> frames_;
};

Pose mounting_of(const FrameSource& folder) {
  const CameraModel& camera = folder.camera().model();
  return {camera.mount_x_m, camera.mount_y_m, camera.mount_yaw_rad};
}

// Metres of odometry per unit of the model, over motions of the camera between consecutive frames.
std::optional<double> scale_by_odometry(const FrameSource& folder,
                                        const std::map<std::size_t, Pose>& poses) {
  if (!folder.has_odometry()) return std::nullopt;
  const Pose mount = mounting_of(folder);
  double metres = 0.0;
  double units = 0.0;
  for (const auto& [frame, pose] : poses) {
    const auto next = poses.find(frame + 1);
    if (next == poses.end()) continue;
    const Pose& of_body = folder.info(frame + 1).motion->mean;
    metres += compose(inverse(mount), compose(of_body, mount)).position().norm();
    units += (next->second.position() - pose.position()).norm();
  }
  if (!(metres > 0.0 && units > 0.0)) return std::nullopt;
  return metres / units;
}

std::string degrees_text(double radians) {
  return short_number(radians * 180.0 / std::numbers::pi) + " deg";
}

// Those that are pictures of the survey, by their names.
void keep_pictures_of(const Survey& survey, const fs::path& folder, const fs::path& file,
                      std::vector<NamedCamera>& cameras) {
  std::erase_if(cameras, [&](const NamedCamera& camera) { return !survey.frame(camera.name); });
  if (cameras.empty()) {
    throw InputError(file.string(), "none of its images is a picture of " + folder.string() +
                                        "; pictures are matched by their names");
  }
}

// The cameras' poses in the plane by their frames, in the units of the model.
std::map<std::size_t, Pose> poses_by_frame(const std::vector<NamedCamera>& cameras,
                                           const std::vector<Pose>& poses,
                                           const std::optional<Survey>& survey,
                                           const fs::path& file) {
  std::map<std::size_t, Pose> by_frame;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::size_t frame = survey ? *survey->frame(cameras[i].name) : i;
    if (!by_frame.emplace(frame, poses[i]).second) {
      throw InputError(file.string(),
                       "has two images by the name of " + in_quotes(cameras[i].name));
    }
  }
  return by_frame;
}

// The body's poses in metres, where the survey says how the camera is mounted; else the camera's,
// a second apart.
std::vector<StampedPose> reference_of(const std::map<std::size_t, Pose>& by_frame, double scale,
                                      const std::optional<Survey>& survey) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  std::vector<StampedPose> reference;
  reference.reserve(by_frame.size());
  for (const auto& [frame, in_model] : by_frame) {
    const Pose pose{in_model.x * scale, in_model.y * scale, in_model.theta};
    if (survey) {
      reference.push_back({survey->folder().info(frame).time_ns,
                           compose(pose, inverse(mounting_of(survey->folder())))});
    } else {
      reference.push_back({static_cast<std::int64_t>(frame) * kSecond, pose});
    }
  }
  return reference;
}

// What the plane and the scale are worth.
void say_geometry(const PlanarCameras& planar, double scale, ImportReport& report) {
  report.facts.push_back(fmt::format(
      "off the plane that fits best: {} m rms; tilt of the optical axes: median {}, most {}",
      short_number(planar.rms_off_plane * scale), degrees_text(planar.median_tilt_rad),
      degrees_text(planar.most_tilt_rad)));
  if (planar.is_normal_by_view) {
    report.notes.emplace_back(
        "the cameras lie along a line, or their heights differ by more than the survey is wide: "
        "the plane is that across their mean optical axis");
  }
  report.notes.push_back("a model has no scale: one unit is taken for " + short_number(scale, 6) +
                         " m (--scale)");
}

}  // namespace

ImportReport import_colmap(const fs::path& model, const PoseImportOptions& options,
                           const fs::path& folder) {
  const fs::path file = model / "images.txt";
  std::vector<NamedCamera> cameras = read_images(file);
  const std::size_t images = cameras.size();
  ImportReport report;
  std::optional<Survey> survey;
  if (!options.survey.empty()) {
    survey.emplace(options.survey, report.notes);
    keep_pictures_of(*survey, options.survey, file, cameras);
  }
  std::vector<CameraPose> poses;
  poses.reserve(cameras.size());
  for (const NamedCamera& camera : cameras) poses.push_back(camera.pose);
  const PlanarCameras planar = project_to_plane(poses);
  const std::map<std::size_t, Pose> by_frame = poses_by_frame(cameras, planar.poses, survey, file);
  const std::vector<StampedPose> reference = reference_of(by_frame, options.scale, survey);
  write_reference_poses(reference, folder);

  report.facts.push_back(fmt::format("{} poses of {} images", reference.size(), images));
  say_geometry(planar, options.scale, report);
  std::set<std::int64_t> used;
  for (const NamedCamera& camera : cameras) used.insert(camera.camera_id);
  write_colmap_camera(model, used, survey ? survey->folder().camera().model() : CameraModel{},
                      folder, report);
  if (!survey) {
    report.notes.emplace_back(
        "no --survey: poses are numbered by the names of their images, a second apart");
  } else if (const auto scale = scale_by_odometry(survey->folder(), by_frame)) {
    report.notes.push_back("by the odometry of the survey one unit is " + short_number(*scale, 4) +
                           " m");
  }
  return report;
}

}  // namespace fathom
