#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "fathom/datasets/frame_source.hpp"
#include "fathom/front_end/once_map.hpp"
#include "fathom/vision/features.hpp"

namespace fathom {

/// Features in little memory: SIFT's descriptors are whole numbers from 0 to 255, so a byte holds
/// each of them without loss. Descriptors that a byte cannot hold are kept as they are.
class PackedFeatures {
 public:
  explicit PackedFeatures(Features features);

  /// The same features, bit for bit.
  Features unpacked() const;
  std::size_t size() const { return packed_.size(); }
  std::size_t bytes() const;

 private:
  Features packed_;
  int type_ = 0;  ///< of the descriptors, unpacked
};

/// The features of frames, in pixels, extracted when first asked for: an LRU cache bounded in
/// bytes. Each frame's are extracted once as long as they fit. May be used from several threads at
/// once: who needs features that another thread extracts waits for them.
class FeatureMemory {
 public:
  /// The source must outlive it.
  FeatureMemory(const FrameSource& source, const FeatureExtractor& extractor, std::size_t bytes);

  /// Throws InputError where the picture cannot be read, as often as it is asked for.
  std::shared_ptr<const PackedFeatures> of(std::size_t frame);

  /// Prefetches a frame: extracts it in the background, on one thread of its own: pictures one
  /// beside the other scale better than the parts of one. What fails is said when it is asked for.
  /// With one thread (cv::setNumThreads) there is no background.
  void announce(std::size_t frame);

  /// Of the features held that were asked for.
  std::size_t bytes() const { return held_.cost(); }

 private:
  using Held = std::shared_ptr<const PackedFeatures>;

  Held extract(std::size_t frame) const;

  const FrameSource& source_;
  FeatureExtractor extractor_;
  OnceMap<std::size_t, Held> held_;
};

}  // namespace fathom
