#pragma once

#include <cstdint>
#include <memory>

#include "fathom/datasets/frame_source.hpp"
#include "fathom/datasets/noisy_odometry.hpp"
#include "fathom/front_end/pair_registrar.hpp"
#include "fathom/front_end/visual_odometry.hpp"
#include "fathom/study/configuration.hpp"

namespace fathom {

/// The frames of a configuration's data set, opened, with dead reckoning whatever its source.
class Survey {
 public:
  /// The data set must be one of pictures. Registrations are looked up in the cache and kept there,
  /// where there is one; it must outlive this. Throws InputError.
  explicit Survey(const Configuration& configuration, RegistrationCache* cache = nullptr);

  /// Frames with dead reckoning: recorded, with noise added or not, simulated, or visual odometry.
  const FrameSource& frames() const;
  PairRegistrar& registrar() { return *registrar_; }
  bool uses_visual_odometry() const { return visual_odometry_ != nullptr; }
  std::size_t visual_odometry_failures() const;

 private:
  void open(const Configuration& configuration, RegistrationCache* cache);
  void add_noise(const AddedNoise& noise, const FrontEndOptions& options);

  std::unique_ptr<FrameSource> source_;
  std::unique_ptr<PairRegistrar> registrar_;
  std::unique_ptr<VisualOdometry> visual_odometry_;
  std::unique_ptr<NoisyOdometry> noisy_odometry_;
};

}  // namespace fathom
