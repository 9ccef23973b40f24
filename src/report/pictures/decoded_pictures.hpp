#pragma once

#include <algorithm>
#include <cstddef>
#include <list>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

#include "fathom/datasets/frame_source.hpp"

namespace fathom {

/// Pictures as they were decoded; those not asked for longest make room.
class DecodedPictures {
 public:
  DecodedPictures(const FrameSource& source, std::size_t most_bytes)
      : source_(source), most_bytes_(most_bytes) {}

  /// Before picture() of these in turn: where the first is not known it is decoded beside the next
  /// ones, as many as there are threads and room for.
  void prepare(std::span<const std::size_t> frames) {
    if (frames.empty() || places_.contains(frames.front())) return;
    // The first picture of all may take every thread: a simulated floor is drawn for it.
    if (latest_first_.empty()) return;
    const std::size_t room =
        most_bytes_ / std::max<std::size_t>(1, bytes_of(latest_first_.front().second));
    const auto threads = static_cast<std::size_t>(std::max(1, cv::getNumThreads()));
    const std::size_t side_by_side = std::clamp<std::size_t>(room, 1, threads);
    std::vector<std::size_t> missing;
    for (auto at = frames.begin(); at != frames.end() && missing.size() < side_by_side; ++at) {
      const bool is_new = std::ranges::find(missing, *at) == missing.end();
      if (is_new && !places_.contains(*at)) missing.push_back(*at);
    }
    std::vector<cv::Mat> pictures(missing.size());
    cv::parallel_for_({0, static_cast<int>(missing.size())}, [&](const cv::Range& range) {
      for (int i = range.start; i < range.end; ++i) {
        pictures[static_cast<std::size_t>(i)] = source_.image(missing[static_cast<std::size_t>(i)]);
      }
    });
    for (std::size_t i = missing.size(); i-- > 0;) keep(missing[i], pictures[i]);
  }

  /// The first of these, at most `count`.
  std::vector<cv::Mat> first_of(std::span<const std::size_t> frames, std::size_t count) {
    std::vector<cv::Mat> pictures;
    for (; !frames.empty() && pictures.size() < count; frames = frames.subspan(1)) {
      prepare(frames);
      pictures.push_back(picture(frames.front()));
    }
    return pictures;
  }

  cv::Mat picture(std::size_t frame) {
    const auto known = places_.find(frame);
    if (known != places_.end()) {
      latest_first_.splice(latest_first_.begin(), latest_first_, known->second);
      return known->second->second;
    }
    keep(frame, source_.image(frame));
    return latest_first_.front().second;
  }

 private:
  using Entry = std::pair<std::size_t, cv::Mat>;

  static std::size_t bytes_of(const cv::Mat& picture) {
    return picture.total() * picture.elemSize();
  }
  void keep(std::size_t frame, const cv::Mat& picture) {
    latest_first_.emplace_front(frame, picture);
    places_[frame] = latest_first_.begin();
    bytes_ += bytes_of(picture);
    while (bytes_ > most_bytes_ && latest_first_.size() > 1) forget_last();
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
