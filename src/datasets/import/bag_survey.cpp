#include "bag_survey.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "bag_picture.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/asl_files.hpp"

namespace fathom {
namespace {

std::string size_text(int width, int height) {
  return fmt::format("{} x {} pixels", width, height);
}

BagPicture picture_in(const BagMessage& message, const BagTopic& topic, std::int64_t& stamp_ns,
                      std::string& frame) {
  if (topic.type == "sensor_msgs/Image") {
    const ImageMessage image = read_image(message.reader);
    stamp_ns = image.stamp_ns;
    frame = image.frame;
    return picture_of(image);
  }
  const CompressedImageMessage image = read_compressed_image(message.reader);
  stamp_ns = image.stamp_ns;
  frame = image.frame;
  return picture_of(image);
}

}  // namespace

BagSurvey::BagSurvey(const std::vector<BagTopic>& topics, const TopicChoice& choice,
                     const BagImportOptions& options, std::filesystem::path pictures_folder)
    : camera_info(topics[*choice.images].name),
      topics_(topics),
      choice_(choice),
      options_(options),
      folder_(std::move(pictures_folder)) {
  for (const BagTopic& topic : topics) stamps_.emplace_back(topic.name, options);
}

void BagSurvey::take(const BagMessage& message) {
  const BagTopic& topic = topics_[message.topic];
  try {
    if (choice_.images == message.topic) take_picture(message, topic);
    if (choice_.camera_info == message.topic) {
      camera_info.take(read_camera_info(message.reader), message.record_time_ns);
    }
    if (choice_.altitude == message.topic) take_altitude(message, topic);
    if (choice_.odometry == message.topic || choice_.reference == message.topic) {
      take_pose(message, topic);
    }
    if (choice_.heading == message.topic || choice_.attitude == message.topic) take_imu(message);
    if (std::ranges::count(choice_.transforms, message.topic) > 0) {
      frames.take(read_transforms(message.reader));
    }
  } catch (const InputError& error) {
    const std::string what = error.what();
    throw InputError(
        what.find(topic.name) == std::string::npos ? "topic " + topic.name + ": " + what : what);
  }
}

std::optional<std::int64_t> BagSurvey::time_of(const BagMessage& message,
                                               std::optional<std::int64_t> stamp_ns) {
  const auto time_ns = stamps_[message.topic].next(message.record_time_ns, stamp_ns);
  if (!time_ns) ++repeated;
  return time_ns;
}

void BagSurvey::take_picture(const BagMessage& message, const BagTopic& topic) {
  std::int64_t stamp_ns = 0;
  std::string frame;
  const BagPicture picture = picture_in(message, topic, stamp_ns, frame);
  const auto time_ns = time_of(message, stamp_ns);
  if (!time_ns) return;
  if (pictures.empty()) {
    camera_frame = frame;
    width = picture.width;
    height = picture.height;
  }
  if (picture.width != width || picture.height != height) {
    throw InputError(fmt::format("picture {} has {}, the first has {}; all must have the same size",
                                 pictures.size() + 1, size_text(picture.width, picture.height),
                                 size_text(width, height)));
  }
  pictures.push_back({*time_ns, std::to_string(*time_ns) + picture.extension});
  write_file(folder_ / pictures.back().file, picture.bytes);
}

void BagSurvey::take_altitude(const BagMessage& message, const BagTopic& topic) {
  const int axis = options_.altitude_axis.front() - 'x';
  const ScalarMessage scalar = read_scalar(topic.type, axis, message.reader);
  const auto time_ns = time_of(message, scalar.stamp_ns);
  if (!time_ns) return;
  if (std::isfinite(scalar.value) && scalar.value > 0.0) {
    altitudes.emplace_back(*time_ns, scalar.value);
  } else {
    ++bad_altitudes;
  }
}

void BagSurvey::take_pose(const BagMessage& message, const BagTopic& topic) {
  const PoseMessage pose = read_pose(topic.type, message.reader);
  const auto time_ns = time_of(message, pose.stamp_ns);
  if (!time_ns) return;
  planar_pose(pose);  // refuses what is none
  if (choice_.odometry == message.topic) {
    if (odometry.empty()) body_frame = pose.child_frame;
    odometry.push_back({*time_ns, pose});
  }
  if (choice_.reference == message.topic) reference.push_back({*time_ns, pose});
}

void BagSurvey::take_imu(const BagMessage& message) {
  const ImuMessage imu = read_imu(message.reader);
  const auto time_ns = time_of(message, imu.stamp_ns);
  if (!time_ns || !imu.has_rotation) return;
  PoseMessage pose;
  pose.rotation = imu.rotation;
  const double yaw_rad = planar_pose(pose).theta;  // refuses what is no orientation
  if (!imu.is_default) oriented_.insert(message.topic);
  if (choice_.heading == message.topic) {
    headings.push_back({*time_ns, yaw_rad, imu.yaw_variance});
  }
  if (choice_.attitude == message.topic) attitudes.push_back(attitude_of(*time_ns, imu));
}

void BagSurvey::finish() {
  if (choice_.heading && !oriented_.contains(*choice_.heading)) headings.clear();
  if (choice_.attitude && !oriented_.contains(*choice_.attitude)) attitudes.clear();
  // Some drivers write a variance of 1e6 for what they do not know.
  const auto drop_unknown = [](auto& readings, double most_sigma_rad) {
    return std::erase_if(readings, [=](const auto& reading) {
      return !(std::sqrt(reading.variance) <= most_sigma_rad);
    });
  };
  unknown_headings = drop_unknown(headings, std::numbers::pi);
  if (!options_.attitude_sigma_rad) unknown_attitudes = drop_unknown(attitudes, kMostTiltSigmaRad);
  std::ranges::sort(pictures, {}, &WrittenPicture::time_ns);
  std::ranges::sort(altitudes);
  std::ranges::sort(odometry, {}, &OdometryReading::time_ns);
  std::ranges::sort(reference, {}, &OdometryReading::time_ns);
  std::ranges::sort(headings, {}, &HeadingReading::time_ns);
  std::ranges::sort(attitudes, {}, &AttitudeReading::time_ns);
  check_times();
}

std::vector<std::string> BagSurvey::late_notes() const {
  std::vector<std::string> notes;
  for (const StampedTopic& topic : stamps_) {
    if (topic.late() == 0) continue;
    notes.push_back(fmt::format("{} of {} out of order, by {} s at most: put in that of its stamps",
                                counted(topic.late(), "message"), topic.name(),
                                short_number(topic.most_late_s())));
  }
  return notes;
}

void BagSurvey::check_times() const {
  if (options_.clock != BagClock::automatic) return;
  const StampedTopic& of_pictures = stamps_[*choice_.images];
  for (const auto& topic : {choice_.images, choice_.altitude, choice_.odometry, choice_.reference,
                            choice_.heading, choice_.attitude}) {
    if (!topic) continue;
    stamps_[*topic].check_rate();
    check_clocks(of_pictures, stamps_[*topic], options_.max_clock_offset_s);
  }
}

}  // namespace fathom
