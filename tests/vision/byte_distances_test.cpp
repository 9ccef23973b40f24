// Distances of descriptors by products of bytes: the same numbers as one by one.

#include "src/vision/byte_distances.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "fathom/core/cpu.hpp"
#include "fathom/core/random.hpp"

namespace fathom {
namespace {

cv::Mat descriptors(int rows, int length, std::uint64_t seed) {
  RandomStream random(seed, "descriptors");
  cv::Mat result(rows, length, CV_32F);
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < length; ++i) {
      result.at<float>(row, i) = static_cast<float>(random.index(256));
    }
  }
  return result;
}

void expect_exact(const cv::Mat& from, const cv::Mat& to) {
  const auto bytes = ByteDistances::between(from, to);
  ASSERT_TRUE(bytes);
  constexpr float kUntouched = -7.0F;
  const int stride = to.rows + 5;
  for (int first = 0; first < from.rows; first += 37) {
    const int rows = std::min(37, from.rows - first);
    std::vector<float> costs(static_cast<std::size_t>(rows) * static_cast<std::size_t>(stride),
                             kUntouched);
    bytes->fill(first, rows, costs.data(), stride);
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < stride; ++c) {
        const float cost = costs[static_cast<std::size_t>(r) * static_cast<std::size_t>(stride) +
                                 static_cast<std::size_t>(c)];
        double expected = kUntouched;  // beyond the last column nothing is written
        if (c < to.rows) expected = cv::norm(from.row(first + r), to.row(c), cv::NORM_L2SQR);
        ASSERT_EQ(cost, static_cast<float>(expected)) << first + r << ", " << c;
      }
    }
  }
}

class Bytes : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_avx512_vnni())
      GTEST_SKIP() << "does not apply: this processor has no products of bytes";
  }
};

TEST_F(Bytes, GiveTheDistancesThatFloatsGive) {
  for (const int rows : {1, 2, 3, 63, 64, 65, 130}) {
    SCOPED_TRACE(rows);
    expect_exact(descriptors(97, 128, 1), descriptors(rows, 128, 2));
  }
  expect_exact(descriptors(5, 4, 3), descriptors(17, 4, 4));
}

TEST_F(Bytes, HoldTheLargestThereAre) {
  const cv::Mat white(9, 128, CV_32F, cv::Scalar(255));
  const cv::Mat black(70, 128, CV_32F, cv::Scalar(0));
  expect_exact(white, black);
  expect_exact(black, white);
  expect_exact(white, white);
}

TEST_F(Bytes, AreForWholeNumbersOfAByteAlone) {
  const cv::Mat fine = descriptors(3, 128, 5);
  for (const float odd : {0.5F, -1.0F, 256.0F, std::numeric_limits<float>::quiet_NaN()}) {
    cv::Mat other = fine.clone();
    other.at<float>(2, 127) = odd;
    EXPECT_FALSE(ByteDistances::between(other, fine));
    EXPECT_FALSE(ByteDistances::between(fine, other));
  }
  EXPECT_FALSE(ByteDistances::between(descriptors(3, 6, 6), descriptors(3, 6, 7)));
}

}  // namespace
}  // namespace fathom
