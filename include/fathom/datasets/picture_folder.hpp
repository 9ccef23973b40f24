#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fathom/core/options.hpp"
#include "fathom/datasets/file_ids.hpp"
#include "fathom/datasets/frame_source.hpp"

namespace fathom {

/// What a folder of plain pictures cannot say of itself.
struct PictureFolderOptions {
  std::string path;
  std::optional<double> altitude_m;         ///< of all pictures; or
  std::string altitudes;                    ///< a CSV file: filename, altitude
  std::string odometry;                     ///< a CSV file, or empty: visual odometry
  std::string mask;                         ///< a picture, 0 where there is no floor, or empty
  std::optional<double> focal_px;           ///< fx; or
  std::optional<double> field_of_view_rad;  ///< across the width of the picture
  std::optional<double> focal_y_px;         ///< absent: that of x
  std::optional<double> cx;                 ///< absent: the middle of the picture
  std::optional<double> cy;
  DistortionModel distortion_model = DistortionModel::radial_tangential;
  std::vector<double> distortion;  ///< its coefficients, or empty
  double mount_x_m = 0.0;
  double mount_y_m = 0.0;
  double mount_yaw_rad = 0.0;
  bool is_mirrored = false;
  double interval_s = 1.0;  ///< between pictures that do not say when they were taken

  void describe(OptionTable& table);
};

/// The pictures of a folder in the order of their names, in which runs of digits count as numbers:
/// JPEG, PNG, TIFF, BMP, PGM; grey or colour, 8 or 16 bit (read_grey_picture). Their times are
/// those of EXIF (DateTimeOriginal) where all have them and they rise, else `interval_s` apart.
/// Hidden files, whose names begin with a point, are none of them.
///
/// `altitudes` and `odometry` have a row for each picture, by its file name, in the same order.
/// Odometry is as in `odometry0` of an image folder, with the name for the time stamp: filename,
/// p_x, p_y, theta, step_var_x, step_var_y, step_var_theta, and perhaps the covariances xy, xt, yt.
class PictureFolder : public FrameSource {
 public:
  /// Decodes the first picture alone. Throws InputError that names the file and line, or the key
  /// with how to find its value where it is missing.
  explicit PictureFolder(const PictureFolderOptions& options);

  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return infos_.size(); }
  const FrameInfo& info(std::size_t i) const override { return infos_[i]; }
  /// Throws InputError where the picture is of another size than the first.
  cv::Mat image(std::size_t i) const override;
  std::uint64_t picture_id(std::size_t i) const override;
  cv::Mat given_mask() const override { return mask_; }
  std::string picture_name(std::size_t i) const override {
    return pictures_[i].filename().string();
  }
  bool has_odometry() const override { return !odometry_.rows.empty(); }
  bool has_ground_truth() const override { return false; }
  RecordedOdometry recorded_odometry() const override { return odometry_; }
  /// The pictures, the CSV files, and the mask.
  std::vector<std::filesystem::path> files() const;
  /// Whether the times of the pictures are those of EXIF.
  bool has_own_times() const { return has_own_times_; }
  /// What was left out, for the user.
  const std::vector<std::string>& remarks() const { return remarks_; }

 private:
  void find_pictures();
  void set_times(double interval_s);
  void set_altitudes(const PictureFolderOptions& options);
  void read_odometry(const std::filesystem::path& csv);

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> pictures_;
  std::vector<std::filesystem::path> other_files_;
  std::vector<FrameInfo> infos_;
  bool has_own_times_ = false;
  Camera camera_;
  cv::Mat mask_;
  std::vector<std::string> remarks_;
  FileIds ids_;
  RecordedOdometry odometry_;  ///< as it is in its file; without rows where there is none
};

/// Whether a folder has pictures in it, and none of the EuRoC/ASL layout.
bool is_plain_picture_folder(const std::filesystem::path& path);

/// Whether a name comes before another one: runs of digits by their value, the rest by its bytes.
bool is_before(const std::string& a, const std::string& b);

}  // namespace fathom
