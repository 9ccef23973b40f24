#pragma once

#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "apps/your_survey.hpp"
#include "fathom/core/text.hpp"
#include "support/pictures.hpp"

namespace fathom::test {

using Rows = std::vector<std::vector<std::string>>;

/// A survey with nothing wrong, and ways to make something so.
class Faults : public YourSurvey {
 protected:
  void SetUp() override {
    YourSurvey::SetUp();
    simulate("data");
  }

  void change(const std::string& sensor, const std::function<void(Rows&)>& edit) const {
    const std::string file = "data/mav0/" + sensor + "/data.csv";
    std::istringstream lines(bytes_of(file));
    std::string text;
    Rows rows;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with('#')) {
        text += line + "\n";
        continue;
      }
      rows.emplace_back();
      for (const std::string_view field : split_csv(line)) rows.back().emplace_back(field);
    }
    edit(rows);
    for (const auto& row : rows) text += joined(row, ",") + "\n";
    write(file, text);
  }

  // f(value, row, rows) for the numbers of a column.
  void map(const std::string& sensor, std::size_t column,
           const std::function<double(double, std::size_t, std::size_t)>& f) const {
    change(sensor, [&](Rows& rows) {
      for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i][column] = exact(f(std::stod(rows[i][column]), i, rows.size()));
      }
    });
  }

  void redraw(const std::function<cv::Mat(const cv::Mat&)>& edit) const {
    for (const auto& entry : std::filesystem::directory_iterator(path("data/mav0/cam0/data"))) {
      const std::string file = entry.path().string();
      write_picture(file, edit(read_picture(file, cv::IMREAD_GRAYSCALE)));
    }
  }

  // In `sensor.yaml` of the camera, the line that begins with the key.
  void set_camera(const std::string& key, const std::string& value) const {
    std::istringstream lines(bytes_of("data/mav0/cam0/sensor.yaml"));
    std::string text;
    for (std::string line; std::getline(lines, line);) {
      text += (line.starts_with(key + ":") ? key + ": " + value : line) + "\n";
    }
    write("data/mav0/cam0/sensor.yaml", text);
  }

  // The first warning of calibrate, and of run: they agree.
  std::string first_said() const {
    const auto first = [](const std::string& out) {
      const std::size_t at = out.find("warning: ");
      return at == std::string::npos ? "" : out.substr(at, out.find('\n', at) - at);
    };
    const std::string calibrated = first(fathom_done({"calibrate", "data"}).out);
    EXPECT_EQ(first(fathom_done({"run", "data", "--out", "run", "--no-mosaic"}).out).substr(0, 40),
              calibrated.substr(0, 40));
    return calibrated;
  }

  // What a run says that is right over all frames.
  std::string survived() const {
    const Ended ran = fathom_done({"run", "data", "--out", "run", "--no-mosaic"});
    EXPECT_LT(number("run", "frame_mean_position_error_m"), 0.05);
    return ran.out;
  }

  // With what was to be written.
  void expect_right() const {
    EXPECT_THAT(fathom_done({"calibrate", "data"}).out,
                ::testing::AllOf(::testing::HasSubstr("nothing is off"),
                                 ::testing::Not(::testing::HasSubstr("warning"))));
    survived();
  }
};

}  // namespace fathom::test
