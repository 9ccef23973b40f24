#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"
#include "fathom/measurements/shared_errors.hpp"
#include "fathom/vision/own_covariances.hpp"

namespace fathom {

/// What is kept of the registration of two frames.
struct PairRegistration {
  bool found = false;
  Pose motion;                                           ///< as of Registration
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< as of Registration
  int inliers = 0;
  SharedErrors shared = {};  ///< as of Registration
  OwnCovariances own = {};   ///< as of Registration

  bool operator==(const PairRegistration&) const = default;
};

/// 128 bits of all that a registration depends on (registration_key.hpp).
struct RegistrationKey {
  std::uint64_t first = 0;
  std::uint64_t second = 0;

  bool operator==(const RegistrationKey&) const = default;
  bool operator<(const RegistrationKey& other) const {
    return std::pair(first, second) < std::pair(other.first, other.second);
  }
};

/// What is made of one picture each, beyond the life of a process: its features, or itself where it
/// was rendered. Both calls may be made from several threads at once, and throw nothing: what a
/// cache cannot do is a miss.
class PictureCache {
 public:
  virtual ~PictureCache() = default;

  /// Byte for byte what was put in, or nothing.
  virtual std::optional<std::string> find(const RegistrationKey& key) = 0;
  virtual void put(const RegistrationKey& key, std::string_view bytes) = 0;
};

/// Registrations beyond the life of a process. Both calls may be made from several threads at once,
/// and throw nothing: what a cache cannot do is a miss.
class RegistrationCache {
 public:
  virtual ~RegistrationCache() = default;

  /// Bit for bit what was put in, or nothing.
  virtual std::optional<PairRegistration> find(const RegistrationKey& key) = 0;
  virtual void put(const RegistrationKey& key, const PairRegistration& value) = 0;

  /// Where the features of pictures, and rendered pictures, are kept, too; null: nowhere.
  virtual PictureCache* pictures() { return nullptr; }
};

}  // namespace fathom
