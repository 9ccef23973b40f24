#pragma once

#include <cstddef>
#include <list>
#include <unordered_map>
#include <utility>

#include <opencv2/core.hpp>

#include "fathom/datasets/frame_source.hpp"

namespace fathom {

/// Pictures as they were decoded; those not asked for longest make room.
class DecodedPictures {
 public:
  DecodedPictures(const FrameSource& source, std::size_t most_bytes)
      : source_(source), most_bytes_(most_bytes) {}

  cv::Mat picture(std::size_t frame) {
    const auto known = places_.find(frame);
    if (known != places_.end()) {
      latest_first_.splice(latest_first_.begin(), latest_first_, known->second);
      return known->second->second;
    }
    latest_first_.emplace_front(frame, source_.image(frame));
    places_[frame] = latest_first_.begin();
    bytes_ += bytes_of(latest_first_.front().second);
    while (bytes_ > most_bytes_ && latest_first_.size() > 1) forget_last();
    return latest_first_.front().second;
  }

 private:
  using Entry = std::pair<std::size_t, cv::Mat>;

  static std::size_t bytes_of(const cv::Mat& picture) {
    return picture.total() * picture.elemSize();
  }
  void forget_last() {
    bytes_ -= bytes_of(latest_first_.back().second);
    places_.erase(latest_first_.back().first);
    latest_first_.pop_back();
  }

  const FrameSource& source_;
  std::size_t most_bytes_;
  std::size_t bytes_ = 0;
  std::list<Entry> latest_first_;
  std::unordered_map<std::size_t, std::list<Entry>::iterator> places_;
};

}  // namespace fathom
