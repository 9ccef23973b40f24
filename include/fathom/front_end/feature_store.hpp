#pragma once

#include <cstddef>
#include <deque>
#include <future>
#include <map>
#include <memory>

#include "fathom/datasets/frame_source.hpp"
#include "fathom/vision/features.hpp"

namespace fathom {

/// The floor features of frames, extracted once as long as somebody holds them or they are among
/// the last few asked for. For one thread; extraction of a frame announced beforehand goes on in
/// another one meanwhile.
class FeatureStore {
 public:
  /// The source must outlive the store.
  FeatureStore(const FrameSource& source, const FeatureOptions& options);

  std::shared_ptr<const FloorFeatures> of(std::size_t frame);

  /// Starts on a frame that will be asked for soon; beyond the last frame it does nothing.
  void announce(std::size_t frame);

 private:
  using Held = std::shared_ptr<const FloorFeatures>;

  Held extract(std::size_t frame) const;
  void keep(std::size_t frame, const Held& features);

  const FrameSource& source_;
  FeatureExtractor extractor_;
  std::map<std::size_t, std::weak_ptr<const FloorFeatures>> known_;
  std::deque<Held> recent_;
  std::map<std::size_t, std::future<Held>> announced_;
};

}  // namespace fathom
