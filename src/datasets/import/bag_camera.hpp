#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "bag_messages.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

/// The camera of the pictures as they are in the bag: K with its distortion, or, for a topic of
/// rectified pictures (a part of its name begins with image_rect), P without; binning and the
/// region of interest applied. Throws InputError on a camera that is not calibrated, on pictures of
/// another size than it says, and on a model of distortion that is not read.
CameraModel camera_of(const CameraInfoMessage& info, const std::string& image_topic, int width,
                      int height);

bool is_rectified(const std::string& image_topic);

/// The one camera that the messages of a topic tell of. Drivers send some without a calibration
/// before they have one.
class BagCameraInfo {
 public:
  /// The pictures that it is of.
  explicit BagCameraInfo(const std::string& image_topic) : rectified_(is_rectified(image_topic)) {}

  /// Throws InputError with the time where the camera is another one than before.
  void take(const CameraInfoMessage& info, std::int64_t record_ns);

  /// The first with a calibration and a size; else the last one; nothing without messages.
  const std::optional<CameraInfoMessage>& info() const { return info_; }
  /// Messages without a calibration or a size.
  std::size_t empty() const { return empty_; }

 private:
  bool is_empty(const CameraInfoMessage& info) const;

  bool rectified_ = false;
  std::optional<CameraInfoMessage> info_;
  std::size_t empty_ = 0;
};

}  // namespace fathom
