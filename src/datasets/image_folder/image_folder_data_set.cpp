// The entry `image_folder`: see image_folder.hpp.

#include <memory>

#include "fathom/datasets/data_set.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/motion_noise.hpp"

namespace fathom {
namespace {

/// Dead reckoning of an image folder: as recorded, where it is, or of its pictures.
enum class FolderOdometry { recorded, visual_odometry };

struct ImageFolderOptions {
  std::string path;
  FolderOdometry odometry = FolderOdometry::recorded;
  AddedNoiseOptions added_noise;

  void describe(OptionTable& table) {
    table.text("path", path, "the folder that holds mav0; relative to the working folder");
    describe_trial(table);
  }
  void describe_trial(OptionTable& table) {
    table.enumeration<FolderOdometry>(
        "odometry.source", odometry,
        {{"recorded", FolderOdometry::recorded},
         {"visual_odometry", FolderOdometry::visual_odometry}},
        "dead reckoning: odometry0, where there is one; or registered pictures in any case");
    table.group("added_noise", added_noise);
  }
  Eigen::Matrix3d noise_covariance() const {
    return added_noise.noise_covariance("dataset.added_noise.");
  }
};

class ImageFolderDataSet : public DataSet {
 public:
  explicit ImageFolderDataSet(const std::string& path) : folder_(path) {}

  const FrameSource* frames() const override { return &folder_; }

  Trial trial(const DataSetValues& values, const TrialNoise& /*noise*/) const override {
    const auto options = options_of<ImageFolderOptions>(values);
    return {nullptr, options.noise_covariance(),
            options.odometry == FolderOdometry::visual_odometry};
  }

  std::vector<std::filesystem::path> files() const override { return folder_.files(); }

 private:
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
        return std::make_unique<ImageFolderDataSet>(options.path);
      });
}

}  // namespace fathom
