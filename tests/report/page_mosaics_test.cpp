// The mosaics of a study's example on its page.

#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fathom/core/files.hpp"
#include "fathom/report/study_report.hpp"
#include "fathom/vision/picture_codecs.hpp"
#include "report/made_mosaic.hpp"
#include "report/study_fixture.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

std::string bytes_of_base64(const std::string& text) {
  std::string bytes;
  unsigned int group = 0;
  int bits = 0;
  for (const char letter : text) {
    const auto digit =
        std::string("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/")
            .find(letter);
    if (digit == std::string::npos) break;
    group = group << 6 | static_cast<unsigned int>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<unsigned char>(group >> bits & 255U));
  }
  return bytes;
}

cv::Mat picture_of(const Json& one) {
  const std::string address = one.at("picture");
  const std::string start = "data:image/jpeg;base64,";
  EXPECT_TRUE(address.starts_with(start));
  return decode_picture(bytes_of_base64(address.substr(start.size())));
}

class PageMosaics : public ::testing::Test {
 protected:
  void SetUp() override {
    FixtureOptions options;
    options.separations.clear();
    options.noises.clear();
    write_fixture(folder_ / "study", options);
  }

  void write_mosaic(const std::string& name, double x, double y,
                    double metres_per_pixel = 0.01) const {
    write_made_mosaic(study() / name, x, y, metres_per_pixel);
  }

  fs::path study() const { return folder_ / "study"; }

  // Written elsewhere, from the folder of the study.
  Json mosaics() const {
    write_study_report(ResultStore::open(study()), folder_ / "out", study());
    const std::string page = read_file(folder_ / "out" / "report.html");
    page_bytes_ = page.size();
    const std::string opening = "<script type=\"application/json\" id=\"mosaics-data\">";
    const std::size_t begin = page.find(opening) + opening.size();
    return Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  }

  mutable std::size_t page_bytes_ = 0;

 private:
  TemporaryFolder folder_;
};

TEST_F(PageMosaics, AreAbsentWhereCompareWroteNone) {
  EXPECT_TRUE(mosaics().is_null());
}

TEST_F(PageMosaics, ShowWhatIsMasked) {
  write_mosaic("iterated", 4.0, 2.0);
  EXPECT_TRUE(mosaics().at("mask").is_null());
  cv::Mat mask(60, 80, CV_8U, cv::Scalar(255));
  mask.rowRange(45, 60).setTo(0);
  write_file(study() / "iterated" / "mask.png", encode_png(mask));
  const Json shown = mosaics().at("mask");
  EXPECT_EQ(shown.at("share"), 0.25);
  EXPECT_EQ(shown.at("where"), "the lowest 25 %");
  const cv::Mat picture = picture_of(shown);
  ASSERT_EQ(picture.size(), mask.size());
  EXPECT_LT(picture.at<unsigned char>(55, 40), 10);
  EXPECT_GT(picture.at<unsigned char>(20, 40), 245);
}

TEST_F(PageMosaics, HaveEveryLoopThatWasUsed) {
  write_mosaic("iterated", 4.0, 2.0);
  std::string registrations = "from,to,fate,nis,weight\n";
  for (int i = 0; i < 200; ++i) registrations += "0,2,used,1,1\n";
  write_file(study() / "iterated" / "registrations.csv", registrations);
  EXPECT_EQ(mosaics().at("mosaics").at(0).at("loops_in_all"), 200);
}

TEST_F(PageMosaics, ShowTheEstimateWhereItIs) {
  write_mosaic("iterated", 4.0, 2.0);
  const Json all = mosaics();
  ASSERT_EQ(all.at("mosaics").size(), 1u);
  EXPECT_TRUE(all.at("differences").empty());
  const Json& one = all.at("mosaics").at(0);
  EXPECT_EQ(one.at("estimator"), "iterated");
  EXPECT_EQ(one.at("width"), 600);
  EXPECT_EQ(one.at("height"), 800);
  // (0, 0), (4, 0) and (4, 2) from the corner at (7, 3), 100 pixels a metre.
  EXPECT_EQ(one.at("path"), Json::parse("[[300, 700], [300, 300], [100, 300]]"));
  EXPECT_EQ(one.at("loops"), Json::parse("[[[300, 700], [100, 300]]]"));  // the one that was used
  EXPECT_EQ(one.at("loops_in_all"), 1);
  const cv::Mat picture = picture_of(one);
  ASSERT_EQ(picture.size(), cv::Size(600, 800));
  EXPECT_NEAR(picture.at<unsigned char>(300, 100), 220, 3);  // where the track ends
  EXPECT_NEAR(picture.at<unsigned char>(300, 300), 100, 3);
  EXPECT_NEAR(picture.at<unsigned char>(760, 300), 255, 3);
}

TEST_F(PageMosaics, SayWhereTwoDiffer) {
  write_mosaic("iterated", 4.0, 2.0);
  write_mosaic("graph", 4.0, 1.0);
  const Json all = mosaics();
  ASSERT_EQ(all.at("mosaics").size(), 2u);
  ASSERT_EQ(all.at("differences").size(), 1u);
  const Json& pair = all.at("differences").at(0);
  EXPECT_EQ(pair.at("a"), "iterated");  // the best of the fixture
  EXPECT_EQ(pair.at("b"), "graph");
  // Both show 7 m by 6 m; a square metre is bright in each alone.
  EXPECT_NEAR(pair.at("common_m2"), 42.0, 1e-6);
  EXPECT_NEAR(pair.at("share_differs"), 2.0 / 42.0, 1e-6);
  EXPECT_EQ(pair.at("estimates").at("most_m"), 0.0);
  const cv::Mat picture = picture_of(pair);
  const auto at = [&](int v, int u) { return picture.at<cv::Vec3b>(v, u); };  // blue, green, red
  EXPECT_GT(at(300, 100)[2], at(300, 100)[0] + 60);                           // of a: orange
  EXPECT_GT(at(300, 200)[0], at(300, 200)[2] + 60);                           // of b: blue
  EXPECT_NEAR(at(600, 300)[0], at(600, 300)[2], 4);
}

TEST_F(PageMosaics, OfAnotherResolutionAreBinnedToOne) {
  write_mosaic("iterated", 4.0, 2.0, 0.01);
  write_mosaic("graph", 4.0, 2.0, 0.04);
  const Json pair = mosaics().at("differences").at(0);
  EXPECT_NEAR(pair.at("metres_per_pixel"), 0.04, 1e-12);
  EXPECT_NEAR(pair.at("common_m2"), 42.0, 0.3);
  EXPECT_LT(pair.at("share_differs"), 0.01);  // but for the border of the square
}

TEST_F(PageMosaics, LargeOnesAreShrunkAndThePageStaysSmall) {
  for (const std::string name : {"iterated", "a&b_<c>%", "graph"}) {
    write_mosaic(name, 4.0, 2.0, 0.0015);
  }
  const Json all = mosaics();
  ASSERT_EQ(all.at("mosaics").size(), 3u);
  ASSERT_EQ(all.at("differences").size(), 2u);
  for (const char* list : {"mosaics", "differences"}) {
    for (const Json& one : all.at(list)) {
      EXPECT_LE(one.at("width").get<int>() * one.at("height").get<int>(), 1'250'000);
      EXPECT_GE(one.at("width").get<int>() * one.at("height").get<int>(), 500'000);
    }
  }
  // The path is in pixels of the small picture.
  const Json& one = all.at("mosaics").at(0);
  EXPECT_NEAR(one.at("path").at(0).at(0), 3.0 / one.at("metres_per_pixel").get<double>(), 0.11);
  EXPECT_LT(page_bytes_, 20'000'000u);
}

TEST_F(PageMosaics, DamagedFilesAreLeftOut) {
  write_mosaic("iterated", 4.0, 2.0);
  for (const auto& [file, content] :
       std::vector<std::pair<std::string, std::string>>{{"mosaic.png", "no picture"},
                                                        {"mosaic.json", "{\"metres_per_pixel\": 1"},
                                                        {"mosaic.json", "{}"},
                                                        {"mosaic.json", "[]"},
                                                        {"trajectory.tum", "1 2 3\n"}}) {
    write_mosaic("graph", 4.0, 2.0);
    write_file(study() / "graph" / file, content);
    EXPECT_EQ(mosaics().at("mosaics").size(), 1u) << file;
  }
  write_mosaic("graph", 4.0, 2.0);
  fs::remove(study() / "graph" / "registrations.csv");
  EXPECT_EQ(mosaics().at("mosaics").size(), 1u);
}

}  // namespace
}  // namespace fathom::test
