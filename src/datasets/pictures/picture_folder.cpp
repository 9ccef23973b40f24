#include "fathom/datasets/picture_folder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <utility>

#include "exif.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/camera_doubts.hpp"
#include "fathom/datasets/camera_options.hpp"
#include "fathom/datasets/picture_file.hpp"
#include "picture_table.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

bool is_picture(const fs::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a')
                                          : static_cast<char>(letter);
  });
  const std::vector<std::string> endings{".jpg", ".jpeg", ".png", ".tif", ".tiff",
                                         ".bmp", ".pgm",  ".ppm", ".webp"};
  return std::ranges::find(endings, ending) != endings.end();
}

std::string missing_focal_length(const fs::path& picture, int width) {
  std::string text =
      "dataset.camera.focal_px: not given; it is fx of a calibration, or width in pixels x focal "
      "length in mm / sensor width in mm; or give dataset.camera.field_of_view_rad";
  if (const auto focal_mm = read_exif(picture).focal_35mm_mm) {
    constexpr double kFrameWidthMm = 36.0;
    char hint[96];
    std::snprintf(hint, sizeof hint, " (by the EXIF of %s it is about %.0f in air)",
                  picture.filename().c_str(), *focal_mm / kFrameWidthMm * width);
    text += hint;
  }
  return text;
}

// Half the width, in focal lengths, of a picture that the lens fills up to so many radians from its
// axis on either side.
double half_width_at(const CameraModel& lens, double angle_rad) {
  CameraModel small;
  small.width = small.height = 1;
  small.fx = small.fy = 1000.0;
  small.cx = small.cy = 0.0;
  small.distortion_model = lens.distortion_model;
  small.distortion = lens.distortion;
  const Camera camera(small);
  const double side = std::tan(angle_rad);
  const Eigen::Vector2d left = camera.pixel({0.0, side}, 1.0);
  const Eigen::Vector2d right = camera.pixel({0.0, -side}, 1.0);
  constexpr double kRounded = 1e-6;
  // Elsewhere the lens shows the same place of the picture twice.
  if (std::abs(camera.floor_point(left, 1.0).y() - side) < kRounded * side) {
    return 0.5 * (right.x() - left.x()) / small.fx;
  }
  throw InputError(
      "dataset.camera.field_of_view_rad: the lens of dataset.camera.distortion shows no "
      "such angle; expected a smaller one, or focal_px");
}

double focal_length(const PictureFolderOptions& options, const CameraModel& lens,
                    const fs::path& picture) {
  if (options.focal_px && options.field_of_view_rad) {
    throw InputError(
        "dataset.camera.field_of_view_rad: there is a focal_px, too; expected one of them");
  }
  if (options.focal_px) return *options.focal_px;
  if (!options.field_of_view_rad) throw InputError(missing_focal_length(picture, lens.width));
  return 0.5 * lens.width / half_width_at(lens, 0.5 * *options.field_of_view_rad);
}

Camera camera_of(const PictureFolderOptions& options, const fs::path& picture) {
  const cv::Mat first = read_grey_picture(picture);
  CameraModel model;
  model.width = first.cols;
  model.height = first.rows;
  model.distortion_model = options.distortion_model;
  set_distortion(model, options.distortion, "dataset.camera.distortion");
  model.fx = focal_length(options, model, picture);
  model.fy = options.focal_y_px.value_or(model.fx);
  model.cx = options.cx.value_or((model.width - 1) / 2.0);
  model.cy = options.cy.value_or((model.height - 1) / 2.0);
  model.mount_x_m = options.mount_x_m;
  model.mount_y_m = options.mount_y_m;
  model.mount_yaw_rad = options.mount_yaw_rad;
  model.is_mirrored = options.is_mirrored;
  return Camera(model);
}

}  // namespace

PictureFolder::PictureFolder(const PictureFolderOptions& options) : folder_(options.path) {
  find_pictures();
  camera_ = camera_of(options, pictures_.front());
  for (std::string& doubt : camera_doubts(camera_.model(), "dataset.camera")) {
    remarks_.push_back(std::move(doubt));
  }
  infos_.resize(pictures_.size());
  set_times(options.interval_s);
  set_altitudes(options);
  if (!options.odometry.empty()) read_odometry(options.odometry);
  if (!options.mask.empty()) {
    mask_ = read_mask(options.mask, {camera_.model().width, camera_.model().height});
    other_files_.emplace_back(options.mask);
  }
  ids_ = FileIds(pictures_.size());
}

void PictureFolder::find_pictures() {
  if (folder_.empty()) throw InputError("dataset.path: say where the folder of the pictures is");
  std::error_code error;
  if (!fs::is_directory(folder_, error)) throw InputError(folder_.string(), "is no folder");
  for (const auto& entry : fs::directory_iterator(folder_)) {
    if (!entry.is_regular_file() || !is_picture(entry.path())) continue;
    if (!entry.path().filename().string().starts_with('.')) pictures_.push_back(entry.path());
  }
  if (auto hidden = hidden_pictures_remark(folder_)) remarks_.push_back(std::move(*hidden));
  if (pictures_.empty()) {
    throw InputError(folder_.string(),
                     "holds no pictures; expected files such as .jpg, .png, .tif or .pgm");
  }
  std::ranges::sort(pictures_, [](const fs::path& a, const fs::path& b) {
    return is_before(a.filename().string(), b.filename().string());
  });
}

void PictureFolder::set_times(double interval_s) {
  constexpr double kSecond = 1e9;
  for (std::size_t i = 0; i < infos_.size(); ++i) {
    infos_[i].time_ns = std::llround(static_cast<double>(i) * interval_s * kSecond);
  }
  std::vector<std::int64_t> times_ns;
  for (const fs::path& picture : pictures_) {
    const auto time_ns = read_exif(picture).time_ns;
    if (!time_ns) return;
    if (!times_ns.empty() && *time_ns <= times_ns.back()) {
      remarks_.push_back(picture.string() + ": by its EXIF " +
                         (*time_ns == times_ns.back() ? "at the time of" : "before") +
                         " the picture before it by name; times of EXIF are not used, pictures are "
                         "taken to be dataset.interval_s apart, in the order of their names");
      return;
    }
    times_ns.push_back(*time_ns);
  }
  for (std::size_t i = 0; i < infos_.size(); ++i) infos_[i].time_ns = times_ns[i];
  has_own_times_ = true;
}

void PictureFolder::set_altitudes(const PictureFolderOptions& options) {
  if (options.altitude_m && !options.altitudes.empty()) {
    throw InputError("dataset.altitudes: there is an altitude_m, too; expected one of them");
  }
  if (options.altitude_m) {
    for (FrameInfo& info : infos_) info.altitude_m = *options.altitude_m;
    return;
  }
  if (options.altitudes.empty()) {
    throw InputError(
        "dataset.altitude_m: not given; without the height over the floor pixels cannot become "
        "metres; a CSV file, dataset.altitudes, has one for each picture");
  }
  const PictureTable table(options.altitudes, "filename, altitude", pictures_);
  other_files_.emplace_back(options.altitudes);
  for (std::size_t i = 0; i < infos_.size(); ++i) {
    const double altitude_m = table.real(i, 1);
    if (!(altitude_m > 0.0)) {
      table.refuse(i, "the altitude is not above the floor; expected metres > 0");
    }
    infos_[i].altitude_m = altitude_m;
  }
}

void PictureFolder::read_odometry(const fs::path& csv) {
  const PictureTable table(csv, "filename, p_x, p_y, theta, step_var_x, step_var_y, step_var_theta",
                           pictures_, "step_cov_xy, step_cov_xt, step_cov_yt");
  other_files_.push_back(csv);
  Pose last;
  for (std::size_t i = 0; i < infos_.size(); ++i) {
    const ReckonedRow row{infos_[i].time_ns, table.real(i, 1), table.real(i, 2), table.real(i, 3),
                          false};
    const Pose pose = odometry_.format.pose(row);
    odometry_.rows.push_back(row);
    Eigen::Matrix3d C =
        Eigen::Vector3d(table.real(i, 4), table.real(i, 5), table.real(i, 6)).asDiagonal();
    if (table.columns(i) >= 10) {
      C(0, 1) = C(1, 0) = table.real(i, 7);
      C(0, 2) = C(2, 0) = table.real(i, 8);
      C(1, 2) = C(2, 1) = table.real(i, 9);
    }
    if (i > 0) {
      if (!is_positive_definite(C)) {
        table.refuse(i, "the covariance of the step is not positive definite");
      }
      infos_[i].motion = UncertainPose{between(last, pose), C};
    }
    last = pose;
  }
}

cv::Mat PictureFolder::image(std::size_t i) const {
  const CameraModel& model = camera_.model();
  return read_grey_picture(pictures_[i], {model.width, model.height},
                           fmt::format("the first picture {} x {}; expected pictures of one camera",
                                       model.width, model.height));
}

std::uint64_t PictureFolder::picture_id(std::size_t i) const {
  return ids_.of(i, pictures_[i]);
}

std::vector<fs::path> PictureFolder::files() const {
  std::vector<fs::path> files = pictures_;
  files.insert(files.end(), other_files_.begin(), other_files_.end());
  std::ranges::sort(files);
  return files;
}

bool is_plain_picture_folder(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path / "mav0", error) || fs::is_directory(path / "cam0", error)) {
    return false;
  }
  fs::directory_iterator entry(path, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::error_code unreadable;
    const bool hidden = entry->path().filename().string().starts_with('.');
    if (!hidden && entry->is_regular_file(unreadable) && is_picture(entry->path())) return true;
  }
  return false;
}

}  // namespace fathom
