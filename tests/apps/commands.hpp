#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "apps/command_line.hpp"
#include "fathom/core/files.hpp"
#include "fathom/geometry/trajectory.hpp"
#include "support/pictures.hpp"
#include "support/planar.hpp"

namespace fathom::test {

/// The real program, and a look at what it leaves in its folder.
class Commands : public CommandLine {
 protected:
  void expect_picture(const std::string& name) const {
    const cv::Mat picture = read_picture(path(name));
    ASSERT_FALSE(picture.empty()) << name;
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(picture, mean, deviation);
    EXPECT_GT(deviation[0], 1.0) << name << " is blank";
  }

  std::string bytes_of(const std::string& name) const { return read_file(path(name)); }

  std::vector<StampedPose> tum(const std::string& name) const { return read_tum(path(name)); }

  void expect_same_trajectory(const std::string& a, const std::string& b, double tolerance) const {
    const auto first = tum(a);
    const auto second = tum(b);
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(first[i].time_ns, second[i].time_ns);
      EXPECT_LE(distance(first[i].pose, second[i].pose), tolerance) << i;
    }
  }
};

}  // namespace fathom::test
