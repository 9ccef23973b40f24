#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "fathom/datasets/frame_source.hpp"
#include "fathom/front_end/feature_memory.hpp"
#include "fathom/front_end/once_map.hpp"
#include "fathom/front_end/picture_use.hpp"
#include "fathom/front_end/registration_cache.hpp"
#include "fathom/front_end/registration_key.hpp"

namespace fathom {

/// A frame as it takes part in a registration.
struct MeasuredFrame {
  std::size_t frame = 0;
  double altitude_m = 0.0;  ///< as measured, > 0
  std::optional<MeasuredTilt> tilt = std::nullopt;
  double altitude_sigma_m = 0.0;  ///< as of FrameInfo

  static MeasuredFrame of(const FrameSource& source, std::size_t frame) {
    const FrameInfo& info = source.info(frame);
    return {frame, info.altitude_m, info.tilt, info.altitude_sigma_m};
  }
  Stance stance() const { return {altitude_m, tilt}; }
};

/// Registers the frames of a survey, each pair once, for all who ask: the trials of a study share
/// one, as long as their pictures are the same. May be used from several threads at once; who needs
/// what another thread is at waits for it. What is found does not depend on the number of threads,
/// nor on what was asked before.
class PairRegistrar {
 public:
  static constexpr std::size_t kFeatureBytes = std::size_t{512} << 20;

  /// `pictures` gives camera and pictures, no altitudes nor tilts; it and the cache must outlive
  /// this. `feature_bytes` bounds what the features held take; beyond it some are extracted again.
  /// `use`: features where the picture is masked are none, and a frame whose picture repeats the
  /// one before registers with no other.
  PairRegistrar(const FrameSource& pictures, const FeatureOptions& features,
                const RegistrationOptions& registration, std::uint64_t seed,
                RegistrationCache* cache = nullptr, std::size_t feature_bytes = kFeatureBytes,
                const PictureUse& use = {});

  /// From memory, else from the cache, else registered. Throws InputError where a picture that is
  /// needed cannot be read.
  PairRegistration of(const MeasuredFrame& from, const MeasuredFrame& to);

  /// The same of several, in their order; those that are to be registered in parallel.
  std::vector<PairRegistration> of_all(std::span<const MeasuredFrame> from,
                                       const MeasuredFrame& to);

  /// How many frames ahead to prefetch (announce), so that no thread is idle: one for each.
  /// Extraction takes longer than a registration.
  static std::size_t look_ahead();

  /// Prefetches for a pair that will be asked for soon: the features of `to` are extracted in the
  /// background, unless the pair is known and no picture needed. Beyond the last frame it does
  /// nothing.
  void announce(const MeasuredFrame& from, const MeasuredFrame& to);

  /// Whether a pair is known without registering it.
  bool is_known(const MeasuredFrame& from, const MeasuredFrame& to) {
    return known(from, to).has_value();
  }

  /// Pairs registered anew so far, and pairs that the cache knew.
  std::size_t registered() const { return registered_.count(); }
  std::size_t from_cache() const { return from_cache_; }
  /// What registering pairs took, and what extracting features of pictures.
  const WorkMeter& work_on_pairs() const { return registered_; }
  const WorkMeter& work_on_pictures() const { return features_.extracted(); }
  /// What the features held take.
  std::size_t feature_bytes() const { return features_.bytes(); }

 private:
  /// A frame and the bits of what is measured of it: altitude, whether it has a tilt, roll, pitch,
  /// σ.
  using FrameKey = std::tuple<std::size_t, std::uint64_t, std::uint64_t, bool, std::uint64_t,
                              std::uint64_t, std::uint64_t>;
  using PairKey = std::pair<FrameKey, FrameKey>;

  static FrameKey frame_key(const MeasuredFrame& frame);
  static PairKey pair_key(const MeasuredFrame& from, const MeasuredFrame& to);
  RegistrationKey cache_key(const MeasuredFrame& from, const MeasuredFrame& to) const;
  std::uint64_t seed_of(const MeasuredFrame& from, const MeasuredFrame& to) const;
  std::optional<PairRegistration> known(const MeasuredFrame& from, const MeasuredFrame& to);
  FloorFeatures on_floor_of(const MeasuredFrame& frame);
  PairRegistration register_anew(const MeasuredFrame& from, const MeasuredFrame& to,
                                 const FloorFeatures& features_to);

  const FrameSource& pictures_;
  RegistrationOptions options_;
  std::uint64_t seed_;
  RegistrationCache* cache_;
  RegistrationKeys keys_;
  PictureUse use_;
  FeatureMemory features_;
  OnceMap<PairKey, PairRegistration> pairs_;
  WorkMeter registered_;
  std::atomic<std::size_t> from_cache_ = 0;
};

}  // namespace fathom
