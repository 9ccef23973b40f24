#include "fathom/front_end/feature_store.hpp"

#include <utility>

namespace fathom {

FeatureStore::FeatureStore(const FrameSource& source, const FeatureOptions& options)
    : source_(source), extractor_(options) {}

FeatureStore::Held FeatureStore::extract(std::size_t frame) const {
  return std::make_shared<const FloorFeatures>(on_floor(
      extractor_.extract(source_.image(frame)), source_.camera(), source_.info(frame).altitude_m));
}

void FeatureStore::keep(std::size_t frame, const Held& features) {
  // Visual odometry looks one frame back and announces one ahead.
  constexpr std::size_t kRecent = 3;
  known_[frame] = features;
  recent_.push_back(features);
  if (recent_.size() > kRecent) recent_.pop_front();
  std::erase_if(known_, [](const auto& entry) { return entry.second.expired(); });
}

std::shared_ptr<const FloorFeatures> FeatureStore::of(std::size_t frame) {
  if (const auto found = known_.find(frame); found != known_.end()) {
    if (Held features = found->second.lock()) return features;
  }
  Held features;
  if (const auto found = announced_.find(frame); found != announced_.end()) {
    // Taken out first: get() throws what the extraction threw, and has nothing to give after.
    std::future<Held> extraction = std::move(found->second);
    announced_.erase(found);
    features = extraction.get();
  } else {
    features = extract(frame);
  }
  keep(frame, features);
  return features;
}

void FeatureStore::announce(std::size_t frame) {
  if (frame >= source_.size() || announced_.contains(frame)) return;
  if (const auto found = known_.find(frame); found != known_.end() && !found->second.expired()) {
    return;
  }
  announced_.emplace(frame,
                     std::async(std::launch::async, [this, frame] { return extract(frame); }));
}

}  // namespace fathom
