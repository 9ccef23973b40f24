#include "findings.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <string_view>
#include <utility>

#include "fathom/core/text.hpp"

namespace fathom {
namespace {

// What any survey is off by right.
constexpr double kLeastScale = 0.03;
constexpr double kLeastYaw_rad = 0.03;
constexpr double kLeastLever_m = 0.05;
constexpr double kLeastClock_s = 0.05;

std::string seconds_after_start(const CalibrationInput& input, std::int64_t time_ns) {
  return short_number(1e-9 * static_cast<double>(time_ns - input.frame_times_ns.front()), 4);
}

}  // namespace

// Factors that have a name.
std::string named_factor(double factor) {
  const auto is_near = [factor](double named) { return std::abs(std::log(factor / named)) < 0.02; };
  // Behind a flat port a picture shows less, as with a longer focal length; never more.
  if (is_near(1.333)) return "; as a camera calibrated in air has behind a flat port";
  for (const auto& [named, what] : {std::pair(3.2808, "; feet are taken for metres"),
                                    std::pair(100.0, "; centimetres are taken for metres"),
                                    std::pair(1000.0, "; millimetres are taken for metres")}) {
    if (is_near(named) || is_near(1.0 / named)) return what;
  }
  return "";
}

std::string with_sigma(const Estimated& one, int digits) {
  return fmt::format("{:.{}f} ± {}", one.value, digits, short_number(one.sigma, 2));
}

std::string in_file(const CalibrationInput& input, const std::string& line, const char* sensor) {
  if (input.files.are_sensor_yaml) return fmt::format("'{}' in {}/sensor.yaml", line, sensor);
  if (std::string_view(sensor) == "cam0") return fmt::format("'dataset.camera.{}'", line);
  return fmt::format("the rows of {} anew, which are as '{}' says in an image folder", sensor,
                     line);
}

std::string mirror_remedy(const CalibrationInput& input) {
  if (!input.camera.is_mirrored) return "write " + in_file(input, "mirrored: true", "cam0");
  return input.files.are_sensor_yaml ? "take 'mirrored: true' out of cam0/sensor.yaml"
                                     : "take 'dataset.camera.mirrored: true' out";
}

namespace {

// What makes such an order, and what is to be done.
std::string remedy_of(const CalibrationInput& input, const std::vector<MovedPictures>& moved) {
  const std::size_t last = input.motions.back().to;
  const MovedPictures& front = moved.front();
  if (moved.size() == 2 && front.first == 0 && front.places > 0 && moved[1].places < 0 &&
      moved[1].last == last) {
    return fmt::format(
        "a counter that rolled over makes such an order: in cam0/data.csv begin with the file name "
        "of about picture {}",
        moved[1].first + 1);
  }
  if (moved.size() == 1 && front.last == last) {
    return fmt::format(
        "about there {}, or the clock of the pictures or of odometry0 jumps: compare the file "
        "names "
        "with the time stamps of cam0/data.csv, and correct what is wrong",
        front.places > 0 ? "pictures are missing or rows too many"
                         : "rows are missing or pictures too many");
  }
  return "put their file names into cam0/data.csv in the right order";
}

}  // namespace

// Pictures count from 1, as rows do.
void find_order(const CalibrationInput& input, const SetUp& found,
                std::vector<std::string>& findings) {
  constexpr std::size_t kNamed = 4;
  if (found.moved.empty()) return;
  std::vector<std::string> named;
  for (const MovedPictures& block : found.moved) {
    if (named.size() == kNamed) break;
    const std::string which =
        block.first == block.last
            ? fmt::format("picture {} belongs", block.first + 1)
            : fmt::format("pictures {} to {} belong", block.first + 1, block.last + 1);
    named.push_back(fmt::format("{} {} {}", which,
                                counted(static_cast<std::size_t>(std::abs(block.places)), "place"),
                                block.places > 0 ? "later" : "earlier"));
  }
  const std::size_t more = found.moved.size() - named.size();
  findings.push_back(fmt::format(
      "pictures are not in the order in which dead reckoning passes what they show, from {} s "
      "after the first one on: {}{}; {}",
      seconds_after_start(input, input.frame_times_ns[found.moved.front().first]),
      joined(named, ", "), more > 0 ? fmt::format(", and {} more such", more) : "",
      remedy_of(input, found.moved)));
}

void find_mounting(const CalibrationInput& input, const SetUp& found, bool is_mirrored,
                   std::vector<std::string>& findings) {
  const CameraModel& camera = input.camera;
  const double sense = is_mirrored && !found.is_mirrored ? -1.0 : 1.0;
  const Estimated yaw{sense * found.yaw_rad.value, found.yaw_rad.sigma};
  const Estimated y_m{sense * found.lever_y_m.value, found.lever_y_m.sigma};
  const Estimated off{wrap_angle(yaw.value - camera.mount_yaw_rad), yaw.sigma};
  const bool is_turned = off.is_off(0.0, kFindingSigmas, kLeastYaw_rad);
  const bool x_is_off = found.lever_x_m.is_off(camera.mount_x_m, kFindingSigmas, kLeastLever_m);
  const bool y_is_off = y_m.is_off(camera.mount_y_m, kFindingSigmas, kLeastLever_m);
  if (!is_turned && !x_is_off && !y_is_off) return;
  std::string text;
  if (is_turned) {
    text = fmt::format("the camera is turned: its mounting has yaw {} rad, and {} is configured",
                       with_sigma(yaw), short_number(camera.mount_yaw_rad));
  }
  if (x_is_off || y_is_off) {
    text += fmt::format("{}the camera is at x {} m, y {} m of the body, and {}, {} is configured",
                        text.empty() ? "" : "; ", with_sigma(found.lever_x_m), with_sigma(y_m),
                        short_number(camera.mount_x_m), short_number(camera.mount_y_m));
  }
  // Cameras are mounted at right angles more often than a little beside.
  constexpr double kQuarter_rad = std::numbers::pi / 2.0;
  constexpr double kBeside_rad = 0.02;
  const double square_rad = kQuarter_rad * std::round(yaw.value / kQuarter_rad);
  const double written_rad =
      std::abs(yaw.value - square_rad) < kBeside_rad ? square_rad : yaw.value;
  const double x_m = x_is_off ? found.lever_x_m.value : camera.mount_x_m;
  const double mount_y_m = y_is_off ? y_m.value : camera.mount_y_m;
  const double yaw_rad = is_turned ? written_rad : camera.mount_yaw_rad;
  const std::string line =
      input.files.are_sensor_yaml
          ? in_file(input,
                    fmt::format("mounting: {{x: {:.3f}, y: {:.3f}, yaw: {:.3f}}}", x_m, mount_y_m,
                                yaw_rad),
                    "cam0")
          : fmt::format(
                "'dataset.camera: {{mount_x_m: {:.3f}, mount_y_m: {:.3f}, mount_yaw_rad: {:.3f}}}'",
                x_m, mount_y_m, yaw_rad);
  findings.push_back(text + "; write " + line);
}

void find_step(const CalibrationInput& input, const SetUp& found,
               std::vector<std::string>& findings) {
  const SetUp::Step& step = *found.step;
  const double share = std::log(step.altitude_factor) / std::log(step.factor.value);
  const bool is_altimeter = share > 0.7 && share < 1.4;
  findings.push_back(fmt::format(
      "registered motions grow by a factor {} against dead reckoning, {} s after the first "
      "picture: {}",
      with_sigma(step.factor), seconds_after_start(input, step.time_ns),
      is_altimeter ? fmt::format("altimeter0 steps there, by {} (its readings are wrong before or "
                                 "after; correct them, or run the parts apart)",
                                 short_number(step.altitude_factor))
                   : "altimeter0 does not step there, so odometry0's scale does"));
}

bool is_scale_off(const SetUp& found) {
  return found.scale.is_off(1.0, kFindingSigmas, kLeastScale);
}

bool errors_make_scale(const SetUp& found) {
  return is_scale_off(found) && found.scale.value > 1.0 &&
         !(found.least_scale.is_off(1.0, kFindingSigmas, kLeastScale) &&
           found.least_scale.value > 1.0);
}

void find_scale(const CalibrationInput& input, const SetUp& found,
                std::vector<std::string>& findings) {
  if (!is_scale_off(found) || errors_make_scale(found)) return;
  const double factor = found.scale.value;
  const std::string remedy =
      input.files.are_sensor_yaml
          ? fmt::format(
                "write {}, fx and fy times {:.3f} in cam0/sensor.yaml, or {}",
                in_file(input, fmt::format("scale: {:.4g}", input.files.altimeter_scale / factor),
                        "altimeter0"),
                factor,
                in_file(input, fmt::format("scale: {:.4g}", input.odometry.format.scale * factor),
                        "odometry0"))
          : fmt::format(
                "write altitudes times {:.4g}, 'dataset.camera.focal_px' times {:.3f}, or dead "
                "reckoning times {:.4g}",
                1.0 / factor, factor, factor);
  findings.push_back(fmt::format(
      "registered motions are {} times as long as dead reckoning has them: altitudes are {:.3f} "
      "times what they should be, or the focal length {:.3f} times, or dead reckoning {:.3f} "
      "times{}; {}",
      with_sigma(found.scale), factor, 1.0 / factor, 1.0 / factor, named_factor(factor), remedy));
}

bool is_late(const SetUp& found) {
  return found.is_clock_told && found.time_offset_s.is_off(0.0, kFindingSigmas, kLeastClock_s);
}

void find_clock(const CalibrationInput& input, const SetUp& found,
                std::vector<std::string>& findings) {
  if (!is_late(found)) return;
  const Estimated late{std::abs(found.time_offset_s.value), found.time_offset_s.sigma};
  findings.push_back(
      fmt::format("odometry0's time stamps are {} s {} than the pictures'; write {}",
                  with_sigma(late), found.time_offset_s.value < 0.0 ? "later" : "earlier",
                  in_file(input,
                          fmt::format("time_offset_s: {:.3f}",
                                      input.odometry.time_offset_s + found.time_offset_s.value),
                          "odometry0")));
}

void find_times(const std::vector<std::int64_t>& times_ns, std::vector<std::string>& findings) {
  constexpr double kLeastInterval_ns = 1e6;  // no camera takes a thousand pictures a second
  if (times_ns.size() < 2) return;
  const double mean_ns = static_cast<double>(times_ns.back() - times_ns.front()) /
                         static_cast<double>(times_ns.size() - 1);
  if (mean_ns >= kLeastInterval_ns) return;
  findings.push_back(
      fmt::format("pictures are {} s apart in the mean; are the time stamps of cam0/data.csv "
                  "microseconds? expected nanoseconds",
                  short_number(1e-9 * mean_ns, 3)));
}

// A principal point far from the middle is that of pictures of another size.
void find_size(const CameraModel& camera, std::vector<std::string>& findings) {
  constexpr double kFar = 0.25;
  const double right = (camera.cx + 0.5) / camera.width;
  const double down = (camera.cy + 0.5) / camera.height;
  if (std::abs(right - 0.5) < kFar && std::abs(down - 0.5) < kFar) return;
  findings.push_back(fmt::format(
      "the pictures' size is not the calibration's: cx, cy are {:.1f}, {:.1f} in pictures of {} x "
      "{}, as in pictures {:.2f} times as large; divide fx, fy, cx and cy of cam0/sensor.yaml by "
      "this, unless the pictures are a part that was cut out",
      camera.cx, camera.cy, camera.width, camera.height, right + down));
}

}  // namespace fathom
