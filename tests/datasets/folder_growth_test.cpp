// Image folders are read in time by their rows.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/datasets/image_folder.hpp"
#include "folder_fixture.hpp"
#include "src/datasets/image_folder/sensor_outliers.hpp"
#include "support/growth.hpp"

namespace fathom {
namespace {

using test::FolderFixture;

/// Frames and readings of three sensors at each of so many milliseconds.
struct LongFolder {
  FolderFixture fixture;

  LongFolder(std::size_t rows, const std::function<std::string(std::size_t)>& altitude,
             const std::function<std::string(std::size_t)>& pose) {
    std::string frames, altitudes, odometry, truth;
    for (std::size_t i = 0; i < rows; ++i) {
      const std::string stamp = std::to_string(1'000'000 * i);
      frames += stamp + ",a.png\n";
      altitudes += stamp + "," + altitude(i) + "\n";
      odometry += stamp + "," + pose(i) + ",1e-6,1e-6,1e-6\n";
      truth += stamp + ",0,0,9,1,0,0,0\n";
    }
    fixture.files["cam0/data.csv"] = frames;
    fixture.files["altimeter0/data.csv"] = altitudes;
    fixture.files["odometry0/data.csv"] = odometry;
    fixture.files["state_groundtruth_estimate0/data.csv"] = truth;
  }
};

TEST(FolderGrowth, RowsTakeTimeByTheirNumber) {
  const auto read = [](std::size_t rows) {
    const LongFolder folder(
        rows, [](std::size_t) { return "2"; },
        [](std::size_t i) { return std::to_string(0.001 * static_cast<double>(i)) + ",0,0"; });
    EXPECT_EQ(ImageFolder(folder.fixture.write()).size(), rows);
  };
  EXPECT_LT(test::growth_of(read, 1000), test::kFarBelowTheSquare);
}

// Each of the times stands between the same two readings that are kept.
TEST(FolderGrowth, SoDoesAStretchWithoutAReading) {
  const auto fill = [](std::size_t readings) {
    TimeLine times;
    for (std::size_t i = 0; i < readings; ++i) times.add(static_cast<std::int64_t>(i));
    std::vector<bool> is_kept(readings, false);
    is_kept.front() = is_kept.back() = true;
    const KeptReadings kept(is_kept);
    for (std::size_t i = 1; i + 1 < readings; ++i) {
      const Filling filled = filling(times, kept, {i, i, 0.0}, times.at(i));
      ASSERT_EQ(filled.bracket.before, 0U);
      ASSERT_EQ(filled.bracket.after, readings - 1);
    }
  };
  EXPECT_LT(test::growth_of(fill, 10'000), test::kFarBelowTheSquare);
}

TEST(KeptReadings, AreFoundOnEitherSide) {
  const KeptReadings kept({false, true, true, false, false, true});
  EXPECT_EQ(kept.before(0), std::nullopt);
  EXPECT_EQ(kept.before(1), 1U);
  EXPECT_EQ(kept.before(4), 2U);
  EXPECT_EQ(kept.before(4, 1), 1U);
  EXPECT_EQ(kept.before(4, 2), std::nullopt);
  EXPECT_EQ(kept.before(5), 5U);
  EXPECT_EQ(kept.after(0), 1U);
  EXPECT_EQ(kept.after(2, 1), 5U);
  EXPECT_EQ(kept.after(3, 1), std::nullopt);
  EXPECT_EQ(kept.after(6), std::nullopt);
}

// Back at the start, turning there and back: every second row might be where odometry starts again.
TEST(FolderGrowth, SoDoesOdometryThatIsAtItsStartAgainAndAgain) {
  const auto read = [](std::size_t rows) {
    const LongFolder folder(
        rows, [](std::size_t) { return "2"; },
        [=](std::size_t i) -> std::string {
          if (i > 0 && i < rows / 2) return "0.0005,0,0";
          return i % 2 == 0 ? "0,0,0" : "0,0,0.3";
        });
    EXPECT_EQ(ImageFolder(folder.fixture.write()).size(), rows);
  };
  EXPECT_LT(test::growth_of(read, 20'000), test::kFarBelowTheSquare);
}

}  // namespace
}  // namespace fathom
