// fathom import: bags, COLMAP models and KITTI poses through the command line.

#include <cstdint>
#include <cstring>
#include <fstream>

#include <gmock/gmock.h>

#include "apps/commands.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "support/bags/survey_bag.hpp"
#include "support/data.hpp"
#include "support/requirements.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::HasSubstr;

class Import : public Commands {
 protected:
  void SetUp() override {
    write("survey.yaml",
          "dataset:\n  type: simulated\n"
          "  world: {metres_per_pixel: 0.02}\n"
          "  mission: {type: single_loop, loop_length_m: 2.4, loop_width_m: 1.6, "
          "loop_overrun_m: 0.8, turn_radius_m: 0.4}\n"
          "  camera: {width: 160, height: 120, fx: 130, fy: 130}\n"
          "  attitude: {both_sigma_rad: 0.02, measured_sigma_rad: 0.004}\n"
          "  odometry: {sigma_x_m: 0.01, sigma_y_m: 0.01, sigma_theta_rad: 0.01}\n");
    fathom_done({"simulate", "survey.yaml", "--out", "simulated"});
  }

  void write_db3(const std::string& name, const SurveyBag& how = {}) const {
    write_survey_bag(ImageFolder(path("simulated")), *ros2_bag_writer(path(name)), how);
  }
};

TEST_F(Import, BagIsCheckedAndRunAsTheSurveyItself) {
  write_db3("dive.db3");
  const Ended imported = fathom_done({"import", "dive.db3", "--out", "dive"});
  EXPECT_THAT(imported.out, AllOf(HasSubstr("--images"), HasSubstr("the growth of the covariance"),
                                  HasSubstr("look at it with: fathom check")));
  EXPECT_THAT(fathom_done({"check", "dive"}).out, HasSubstr("ground truth"));
  EXPECT_THAT(fathom_done({"run", "dive", "--out", "with-compass"}).out,
              HasSubstr("headings and fixes"));
  fathom_done({"run", "dive", "--out", "of-bag", "--set", "dataset.compass.use=false"});
  fathom_done({"run", "simulated", "--out", "of-folder"});
  EXPECT_EQ(json_of("of-bag/metrics.json")["loops_used"],
            json_of("of-folder/metrics.json")["loops_used"]);
  const auto a = tum("of-bag/trajectory.tum");
  const auto b = tum("of-folder/trajectory.tum");
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LT(distance(a[i].pose, b[i].pose), 1e-6) << i;
}

// The folder it would have been in is gone by then.
TEST_F(Import, WhatARunWouldRefuseIsRefusedByTheBagsName) {
  write_db3("dive.db3", {.imu_roll_rad = 0.8});
  write("wide.yaml",
        "resolution: [160, 120]\nintrinsics: [40, 40, 79.5, 59.5]\ndistortion_model: none\n");
  const std::string refused =
      refusal({"import", "dive.db3", "--camera", "wide.yaml", "--out", "dive"});
  EXPECT_THAT(refused, HasSubstr("dive.db3: what is imported from it is no survey: "
                                 "mav0/attitude0/data.csv: at the picture's time"));
  EXPECT_THAT(refused, ::testing::Not(HasSubstr("partial")));
}

TEST_F(Import, BothGenerationsOfRosGiveTheSameFolder) {
  if (ros1_bag_writer(path("probe.bag")) == nullptr) {
    GTEST_SKIP() << kNoRos1Writer;
  }
  write_survey_bag(ImageFolder(path("simulated")), *ros1_bag_writer(path("dive.bag")));
  write_db3("dive.db3");
  fathom_done({"import", "dive.bag", "--out", "one"});
  fathom_done({"import", "dive.db3", "--out", "two"});
  for (const std::string sensor : {"cam0", "altimeter0", "attitude0", "odometry0", "compass0"}) {
    const std::string file = "/mav0/" + sensor + "/data.csv";
    EXPECT_EQ(bytes_of("one" + file), bytes_of("two" + file)) << sensor;
  }
}

TEST_F(Import, BagCutShortIsOneLine) {
  write_db3("dive.db3");
  const std::string whole = bytes_of("dive.db3");
  write("cut.db3", whole.substr(0, whole.size() / 2));
  EXPECT_THAT(refusal({"import", "cut.db3", "--out", "dive"}),
              HasSubstr("cut.db3: cannot be read"));
}

// The first picture finds room, the rest does not.
TEST_F(Import, FullDiskIsOneLineAndLeavesNothing) {
  if (std::string(FATHOM_TEST_PRELOADED).empty()) GTEST_SKIP() << "not with a sanitizer";
  write_db3("dive.db3");
  surroundings_.environment = {{"LD_PRELOAD", FATHOM_TEST_PRELOADED},
                               {"FATHOM_DISK_BYTES", "30000"}};
  EXPECT_THAT(refusal({"import", "dive.db3", "--out", "dive"}),
              HasSubstr("cannot be written: No space left on device"));
}

TEST_F(Import, WhatIsThereIsNotReplaced) {
  write_db3("dive.db3");
  fathom_done({"import", "dive.db3", "--out", "dive"});
  EXPECT_THAT(refusal({"import", "dive.db3", "--out", "dive"}),
              HasSubstr("dive/mav0: is there already; give another --out"));
}

// librosbag follows the offset of a message in its chunk wherever it leads.
TEST_F(Import, DamageWithinABagIsOneLine) {
  if (ros1_bag_writer(path("probe.bag")) == nullptr) {
    GTEST_SKIP() << kNoRos1Writer;
  }
  write_survey_bag(ImageFolder(path("simulated")), *ros1_bag_writer(path("dive.bag")));
  std::string bytes = bytes_of("dive.bag");
  const auto word_at = [&bytes](std::size_t place) {
    std::uint32_t word = 0;
    std::memcpy(&word, &bytes[place], sizeof word);
    return word;
  };
  std::size_t damaged = 0;
  const std::size_t first_record = std::string("#ROSBAG V2.0\n").size();
  for (std::size_t place = first_record; place < bytes.size();) {
    const std::size_t header = place + 4;
    const std::size_t data = header + word_at(place) + 4;
    const bool is_index = bytes.substr(header, word_at(place)).find("op=\x04") != std::string::npos;
    const std::uint32_t offset = 0x70000000;
    if (is_index && ++damaged > 0) std::memcpy(&bytes[data + 8], &offset, sizeof offset);
    place = data + word_at(data - 4);
  }
  ASSERT_GT(damaged, 0u);
  write("damaged.bag", bytes);
  // The address sanitizer would print its report in the child that dies of it.
  surroundings_.environment["ASAN_OPTIONS"] = "handle_segv=0";
  EXPECT_THAT(refusal({"import", "damaged.bag", "--out", "out"}), HasSubstr("damaged.bag: "));
}

TEST_F(Import, CameraOfAFileTakesThePlaceOfTheBags) {
  write_db3("dive.db3");
  write("camera.yaml",
        "resolution: [160, 120]\nintrinsics: [131, 132, 79.5, 59.5]\nmounting: {yaw: 0.5}\n");
  fathom_done({"import", "dive.db3", "--camera", "camera.yaml", "--out", "dive", "--quiet"});
  const CameraModel model = ImageFolder(path("dive")).camera().model();
  EXPECT_EQ(model.fy, 132.0);
  EXPECT_EQ(model.mount_yaw_rad, 0.5);
  write("small.yaml", "resolution: [80, 60]\nintrinsics: [131, 132, 79.5, 59.5]\n");
  EXPECT_THAT(refusal({"import", "dive.db3", "--camera", "small.yaml", "--out", "x"}),
              HasSubstr("small.yaml: is of 80 x 60 pixels"));
}

TEST_F(Import, KittiPosesBecomeTheReferenceOfASurvey) {
  std::string poses;
  for (std::size_t i = 0; i < ImageFolder(path("simulated")).size(); ++i) {
    poses += "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(i) + "\n";
  }
  write("poses.txt", poses);
  const Arguments import{"import",  "poses.txt", "--survey", "simulated",
                         "--scale", "0.5",       "--out",    "simulated/mav0"};
  EXPECT_THAT(refusal(import), HasSubstr("state_groundtruth_estimate0: is there already"));
  fs::remove_all(path("simulated/mav0/state_groundtruth_estimate0"));
  fathom_done(import);
  const ImageFolder survey(path("simulated"));
  EXPECT_EQ(survey.info(4).ground_truth->x, 2.0);
  EXPECT_EQ(tum("simulated/mav0/reference.tum").size(), survey.size());
}

TEST_F(Import, AFlagOfAnotherKindIsRefused) {
  write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  write_db3("dive.db3");
  EXPECT_THAT(refusal({"import", "poses.txt", "--images", "/camera", "--out", "x"}),
              HasSubstr("--images: goes with bags, and the source is none"));
  EXPECT_THAT(refusal({"import", "dive.db3", "--scale", "2", "--out", "x"}),
              HasSubstr("--scale: goes with poses, and the source is a bag"));
}

TEST_F(Import, ListWritesNothing) {
  write_db3("dive.db3");
  const auto before = tree();
  const Ended listed = fathom_done({"import", "dive.db3", "--list"});
  EXPECT_THAT(listed.out, AllOf(HasSubstr("/camera/image_raw"), HasSubstr("--camera-info")));
  EXPECT_EQ(tree(), before);
}

}  // namespace
}  // namespace fathom::test
