#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "attitude_readings.hpp"
#include "bag.hpp"
#include "bag_camera.hpp"
#include "bag_messages.hpp"
#include "fathom/datasets/import.hpp"
#include "frame_tree.hpp"
#include "odometry_steps.hpp"
#include "stamped_topic.hpp"
#include "topic_choice.hpp"

namespace fathom {

/// A picture that is written.
struct WrittenPicture {
  std::int64_t time_ns = 0;
  std::string file;  ///< in cam0/data
};

struct HeadingReading {
  std::int64_t time_ns = 0;
  double yaw_rad = 0.0;
  double variance = 0.0;  ///< rad²; 0: not stated
};

/// What is taken from a bag as its messages arrive: pictures are written at once, the rest is held.
class BagSurvey {
 public:
  /// Pictures are written to `pictures`, which must be there.
  BagSurvey(const std::vector<BagTopic>& topics, const TopicChoice& choice,
            const BagImportOptions& options, std::filesystem::path pictures);

  /// Throws InputError that names the topic.
  void take(const BagMessage& message);

  /// Once all are taken: puts them in the order of their times. Throws InputError where clocks or
  /// spans of time do not agree.
  void finish();

  /// Of each topic that had some, how many messages came out of order.
  std::vector<std::string> late_notes() const;

  std::vector<WrittenPicture> pictures;
  int width = 0;
  int height = 0;
  BagCameraInfo camera_info;
  std::vector<std::pair<std::int64_t, double>> altitudes;
  std::size_t bad_altitudes = 0;  ///< not above zero, or outside of what the sensor measures
  std::vector<OdometryReading> odometry;
  std::vector<OdometryReading> reference;
  std::vector<HeadingReading> headings;
  std::vector<AttitudeReading> attitudes;
  std::size_t unknown_headings = 0;  ///< left out, by their variance
  std::size_t unknown_attitudes = 0;
  FrameTree frames;
  std::string camera_frame;  ///< of the first picture
  std::string body_frame;    ///< of odometry, what moves; empty where the bag does not say
  std::size_t repeated = 0;  ///< messages with the time of the one before

 private:
  void check_times() const;
  void take_picture(const BagMessage& message, const BagTopic& topic);
  void take_altitude(const BagMessage& message, const BagTopic& topic);
  void take_pose(const BagMessage& message, const BagTopic& topic);
  void take_imu(const BagMessage& message);
  /// The time that counts, of a message of a topic.
  std::optional<std::int64_t> time_of(const BagMessage& message,
                                      std::optional<std::int64_t> stamp_ns);

  const std::vector<BagTopic>& topics_;
  const TopicChoice& choice_;
  const BagImportOptions& options_;
  std::filesystem::path folder_;
  std::vector<StampedTopic> stamps_;  ///< of every topic
  /// Topics of an Imu that has an orientation: other than the default in one of its messages.
  std::set<std::size_t> oriented_;
};

}  // namespace fathom
