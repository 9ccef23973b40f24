// The entry `image_folder`: see image_folder.hpp.

#include <memory>

#include "fathom/datasets/data_set.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/motion_noise.hpp"
#include "fathom/datasets/start_options.hpp"

namespace fathom {
namespace {

/// Dead reckoning of an image folder: as recorded, where it is, or of its pictures.
enum class FolderOdometry { recorded, visual_odometry };

struct ImageFolderOptions {
  std::string path;
  FolderOdometry odometry = FolderOdometry::recorded;
  AddedNoiseOptions added_noise;
  OdometryGaps gaps;
  ReadingChoice compass;
  ReadingChoice fixes;
  StartOptions start;
  EarthOriginOptions origin;

  void describe(OptionTable& table) {
    table.text("path", path, "the folder that holds mav0; relative to the working folder");
    gaps.describe(table);
    describe_trial(table);
  }
  void describe_trial(OptionTable& table) {
    table.enumeration<FolderOdometry>(
        "odometry.source", odometry,
        {{"recorded", FolderOdometry::recorded},
         {"visual_odometry", FolderOdometry::visual_odometry}},
        "dead reckoning: odometry0, where there is one; or registered pictures in any case");
    table.group("added_noise", added_noise);
    compass.describe(table, "compass", "compass0");
    fixes.describe(table, "fixes", "position0");
    table.group("start", start);
  }
  void describe_origin(OptionTable& table) { table.group("origin", origin); }
  Eigen::Matrix3d noise_covariance() const {
    return added_noise.noise_covariance("dataset.added_noise.");
  }
};

class ImageFolderDataSet : public DataSet {
 public:
  ImageFolderDataSet(const std::string& path, const OdometryGaps& gaps) : folder_(path, gaps) {}

  const FrameSource* frames() const override { return &folder_; }

  Trial trial(const DataSetValues& values, const TrialNoise& /*noise*/) const override {
    const auto options = options_of<ImageFolderOptions>(values);
    Trial trial;
    trial.added_noise = options.noise_covariance();
    trial.visual_odometry = options.odometry == FolderOdometry::visual_odometry;
    trial.absolute = readings(options);
    trial.start = options.start;
    return trial;
  }

  std::vector<std::string> remarks() const override { return folder_.remarks(); }

  std::vector<std::filesystem::path> files() const override { return folder_.files(); }

 private:
  // What is not used needs no origin either.
  AbsoluteReadings readings(const ImageFolderOptions& options) const {
    FolderSensors sensors = folder_.sensors();
    if (!options.compass.is_used) sensors.compass.reset();
    if (!options.fixes.is_used) sensors.fixes.reset();
    AbsoluteReadings readings = in_world(sensors, options.origin.origin());
    readings.headings = chosen(readings.headings, options.compass);
    readings.fixes = chosen(readings.fixes, options.fixes);
    return readings;
  }

  ImageFolder folder_;
};

}  // namespace

DataSetEntry image_folder_data_set() {
  return make_data_set<ImageFolderOptions>(
      "image_folder", "pictures, altitude and odometry in the EuRoC/ASL layout",
      [](const ImageFolderOptions& options, std::uint64_t /*seed*/) {
        // A noise that cannot be is said before a folder is opened.
        options.noise_covariance();
        if (options.path.empty()) {
          throw InputError("dataset.path: say where the image folder is");
        }
        return std::make_unique<ImageFolderDataSet>(options.path, options.gaps);
      });
}

}  // namespace fathom
