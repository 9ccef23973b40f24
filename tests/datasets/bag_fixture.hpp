#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/import.hpp"
#include "small_survey.hpp"
#include "support/bags/survey_bag.hpp"
#include "support/input_error.hpp"
#include "support/requirements.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {

inline constexpr std::int64_t kSecond = 1'000'000'000;
inline constexpr std::int64_t kBegin = 1'700'000'000 * kSecond;

/// The same tests for both generations of ROS.
class BagTest : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (GetParam() == 2) {
      FATHOM_REQUIRE_FEATURE("fastcdr");
    }
    if (GetParam() == 1 && ros1_bag_writer(folder_ / "probe.bag") == nullptr) {
      GTEST_SKIP() << kNoRos1Writer;
    }
  }

  std::filesystem::path bag() const { return folder_ / (GetParam() == 1 ? "a.bag" : "a.db3"); }
  std::filesystem::path out() const { return folder_ / "out"; }

  std::unique_ptr<BagWriter> writer() const {
    return GetParam() == 1 ? ros1_bag_writer(bag()) : ros2_bag_writer(bag());
  }

  void write_bag(const FrameSource& survey, const SurveyBag& how = {}) const {
    write_survey_bag(survey, *writer(), how);
  }

  ImportReport import(const BagImportOptions& options = {}) const {
    return import_bag(bag(), options, out());
  }
  std::string refusal(const BagImportOptions& options = {}) const {
    return input_error_of([&] { import(options); });
  }

  TemporaryFolder folder_;
};

inline std::string generation(const ::testing::TestParamInfo<int>& info) {
  return "Ros" + std::to_string(info.param);
}

}  // namespace fathom::test
