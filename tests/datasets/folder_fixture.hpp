#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include <opencv2/core.hpp>

#include "support/pictures.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {

/// A hand-written image folder of three frames, each of its files to be replaced or left out.
class FolderFixture {
 public:
  FolderFixture() {
    files = {
        {"cam0/data.csv", "#timestamp [ns],filename\n0,a.png\n1000,b.png\n2000,c.png\n"},
        {"cam0/sensor.yaml",
         "sensor_type: camera\nresolution: [8, 6]\nintrinsics: [10, 10.4, 3.5, 2.5]\n"
         "distortion_model: none\ndistortion_coefficients: []\n"},
        {"altimeter0/data.csv", "#t,altitude\n0,2\n1000,2.5\n2000,3\n"},
        {"odometry0/data.csv",
         "#t,x,y,theta,vx,vy,vt\n0,0,0,0,0,0,0\n1000,1,0,0.5,0.01,0.02,0.001\n"
         "2000,1,2,0.5,0.01,0.02,0.001\n"},
        {"state_groundtruth_estimate0/data.csv",
         "#t,px,py,pz,qw,qx,qy,qz\n0,0,0,9,1,0,0,0\n1000,1,0,9,1,0,0,0\n2000,1,2,9,1,0,0,0\n"}};
  }

  /// Writes what `files` holds and three grey pictures; returns the folder.
  std::filesystem::path write() const {
    for (const auto& [name, text] : files) {
      std::filesystem::create_directories((mav0() / name).parent_path());
      std::ofstream(mav0() / name) << text;
    }
    std::filesystem::create_directories(mav0() / "cam0" / "data");
    for (const char* name : {"a.png", "b.png", "c.png"}) {
      cv::Mat picture(6, 8, CV_8UC1);
      for (int i = 0; i < 48; ++i) picture.at<uchar>(i / 8, i % 8) = static_cast<uchar>(5 * i);
      write_picture(mav0() / "cam0" / "data" / name, picture);
    }
    return root.path();
  }

  std::filesystem::path mav0() const { return root / "mav0"; }

  TemporaryFolder root;
  std::map<std::string, std::string> files;
};

}  // namespace fathom::test
