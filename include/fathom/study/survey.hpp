#pragma once

#include <cstdint>
#include <memory>

#include "fathom/datasets/frame_source.hpp"
#include "fathom/front_end/feature_store.hpp"
#include "fathom/front_end/visual_odometry.hpp"
#include "fathom/study/configuration.hpp"

namespace fathom {

/// The frames of a configuration's data set, opened, with dead reckoning whatever its source.
class Survey {
 public:
  /// The data set must be one of pictures. Throws InputError.
  explicit Survey(const Configuration& configuration);

  /// Frames with dead reckoning: recorded, simulated, or visual odometry.
  const FrameSource& frames() const;
  FeatureStore& features() { return *features_; }
  bool uses_visual_odometry() const { return visual_odometry_ != nullptr; }
  std::size_t visual_odometry_failures() const;

 private:
  void open(const Configuration& configuration);

  std::unique_ptr<FrameSource> source_;
  std::unique_ptr<FeatureStore> features_;
  std::unique_ptr<VisualOdometry> visual_odometry_;
};

}  // namespace fathom
