// The entry `pictures`: see picture_folder.hpp.

#include <memory>

#include "fathom/datasets/data_set.hpp"
#include "fathom/datasets/motion_noise.hpp"
#include "fathom/datasets/picture_folder.hpp"
#include "fathom/datasets/start_options.hpp"

namespace fathom {
namespace {

struct PicturesOptions {
  PictureFolderOptions folder;
  AddedNoiseOptions added_noise;
  StartOptions start;

  void describe(OptionTable& table) {
    folder.describe(table);
    describe_trial(table);
  }
  void describe_trial(OptionTable& table) {
    table.group("added_noise", added_noise);
    table.group("start", start);
  }
  Eigen::Matrix3d noise_covariance() const {
    return added_noise.noise_covariance("dataset.added_noise.");
  }
};

class PicturesDataSet : public DataSet {
 public:
  explicit PicturesDataSet(const PictureFolderOptions& options) : folder_(options) {}

  const FrameSource* frames() const override { return &folder_; }

  Trial trial(const DataSetValues& values, const TrialNoise& /*noise*/) const override {
    const auto options = options_of<PicturesOptions>(values);
    Trial trial;
    trial.added_noise = options.noise_covariance();
    trial.start = options.start;
    return trial;
  }

  std::vector<std::filesystem::path> files() const override { return folder_.files(); }
  std::vector<std::string> remarks() const override { return folder_.remarks(); }

 private:
  PictureFolder folder_;
};

}  // namespace

DataSetEntry pictures_data_set() {
  return make_data_set<PicturesOptions>("pictures",
                                        "a folder of plain pictures, with a height over the floor",
                                        [](const PicturesOptions& options, std::uint64_t /*seed*/) {
                                          options.noise_covariance();
                                          return std::make_unique<PicturesDataSet>(options.folder);
                                        });
}

}  // namespace fathom
