#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fathom/datasets/frame_source.hpp"
#include "fathom/front_end/once_map.hpp"
#include "fathom/front_end/registration_key.hpp"
#include "fathom/vision/features.hpp"

namespace fathom {

/// Pieces of work of one kind that are done, and the time that threads were at them, together.
class WorkMeter {
 public:
  /// Does one piece.
  template <class Work>
  auto measure(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    auto result = work();
    const std::chrono::nanoseconds time = std::chrono::steady_clock::now() - start;
    time_ns_ += time.count();
    ++count_;
    return result;
  }

  std::size_t count() const { return count_; }
  double seconds() const { return 1e-9 * static_cast<double>(time_ns_); }

 private:
  std::atomic<std::int64_t> time_ns_ = 0;
  std::atomic<std::size_t> count_ = 0;
};

/// Features in little memory: SIFT's descriptors are whole numbers from 0 to 255, so a byte holds
/// each of them without loss. Descriptors that a byte cannot hold are kept as they are.
class PackedFeatures {
 public:
  explicit PackedFeatures(Features features);

  /// The same features, bit for bit.
  Features unpacked() const;
  std::size_t size() const { return packed_.size(); }
  std::size_t bytes() const;

  /// As one machine reads it back.
  std::string to_bytes() const;
  /// Of what to_bytes wrote; nothing where the sizes do not fit.
  static std::optional<PackedFeatures> from_bytes(std::string_view bytes);

 private:
  PackedFeatures() = default;

  Features packed_;
  int type_ = 0;  ///< of the descriptors, unpacked
};

/// What a FeatureMemory works on.
struct FeatureSource {
  const FrameSource& pictures;  ///< outlives it
  FeatureExtractor extractor;
  cv::Mat mask = {};              ///< of all pictures, as of FeatureExtractor
  PictureCache* cache = nullptr;  ///< outlives it
  FeatureKeys keys = {};          ///< for the cache
};

/// The features of frames, in pixels, extracted when first asked for unless the cache has them: an
/// LRU cache bounded in bytes. Each frame's are extracted once as long as they fit. May be used
/// from several threads at once: who needs features that another thread extracts waits for them.
class FeatureMemory {
 public:
  FeatureMemory(FeatureSource source, std::size_t bytes);

  /// Throws InputError where the picture cannot be read, as often as it is asked for.
  std::shared_ptr<const PackedFeatures> of(std::size_t frame);

  /// Prefetches a frame: extracts it in the background, on one thread of its own: pictures one
  /// beside the other scale better than the parts of one. What fails is said when it is asked for.
  /// With one thread (cv::setNumThreads) there is no background.
  void announce(std::size_t frame);

  /// Of the features held that were asked for.
  std::size_t bytes() const { return held_.cost(); }
  /// What extraction took.
  const WorkMeter& extracted() const { return extracted_; }

 private:
  using Held = std::shared_ptr<const PackedFeatures>;

  Held extract(std::size_t frame);
  Held make(std::size_t frame);

  FeatureSource source_;
  WorkMeter extracted_;
  OnceMap<std::size_t, Held> held_;
};

}  // namespace fathom
