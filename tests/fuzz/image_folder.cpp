// An image folder of text files, each below a line `==== NAME`, with three pictures of 8×6 pixels
// that are always there: read, and looked at as `fathom check` does.
#include "fathom/datasets/image_folder.hpp"

#include <array>

#include <opencv2/core.hpp>

#include "fathom/datasets/folder_summary.hpp"
#include "support/fuzz.hpp"
#include "support/pictures.hpp"

namespace {

using namespace fathom;

constexpr std::array kFiles{"cam0/data.csv",
                            "cam0/sensor.yaml",
                            "altimeter0/data.csv",
                            "altimeter0/sensor.yaml",
                            "odometry0/data.csv",
                            "odometry0/sensor.yaml",
                            "attitude0/data.csv",
                            "attitude0/sensor.yaml",
                            "compass0/data.csv",
                            "compass0/sensor.yaml",
                            "position0/data.csv",
                            "position0/sensor.yaml",
                            "state_groundtruth_estimate0/data.csv"};

class Survey : public fuzz::Folder {
 public:
  Survey() : Folder("survey") {
    std::filesystem::create_directories(path() / "mav0" / "cam0" / "data");
    cv::Mat picture(6, 8, CV_8UC1);
    for (int i = 0; i < 48; ++i) picture.at<uchar>(i / 8, i % 8) = static_cast<uchar>(5 * i);
    for (const char* name : {"a.png", "b.png", "c.png"}) {
      test::write_picture(path() / "mav0" / "cam0" / "data" / name, picture);
    }
  }

  void put(std::string_view text) const {
    for (const std::string_view name : kFiles) {
      const std::filesystem::path file = path() / "mav0" / name;
      const std::string head = "==== " + std::string(name) + "\n";
      const std::size_t begin = text.find(head);
      if (begin == std::string_view::npos) {
        std::filesystem::remove(file);
        // A folder without files would be a sensor without readings.
        if (file.filename() == "data.csv" && !name.starts_with("cam0")) {
          std::filesystem::remove_all(file.parent_path());
        }
        continue;
      }
      std::filesystem::create_directories(file.parent_path());
      const std::string_view rest = text.substr(begin + head.size());
      write(file, rest.substr(0, rest.find("==== ")));
    }
  }
};

void look_at(const ImageFolder& folder) {
  fuzz::require(folder.files().size() >= folder.size(), "every frame has its picture");
  fuzz::is_taken([&] { summarise_frames(folder); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Survey survey;
  survey.put(fuzz::text_of(data, size));
  fuzz::is_taken([&] { look_at(ImageFolder(survey.path())); });
  return 0;
}
