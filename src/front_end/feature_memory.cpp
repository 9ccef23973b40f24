#include "fathom/front_end/feature_memory.hpp"

#include <utility>

#include <opencv2/core/utility.hpp>

namespace fathom {

PackedFeatures::PackedFeatures(Features features)
    : packed_(std::move(features)), type_(packed_.descriptors.type()) {
  if (type_ != CV_32F) return;
  cv::Mat bytes;
  cv::Mat again;
  packed_.descriptors.convertTo(bytes, CV_8U);
  bytes.convertTo(again, CV_32F);
  if (cv::countNonZero(again != packed_.descriptors) == 0) packed_.descriptors = bytes;
}

Features PackedFeatures::unpacked() const {
  Features features = packed_;
  if (packed_.descriptors.type() != type_)
    packed_.descriptors.convertTo(features.descriptors, type_);
  return features;
}

std::size_t PackedFeatures::bytes() const {
  return sizeof(*this) + packed_.pixels.size() * (sizeof(Eigen::Vector2d) + 2 * sizeof(float)) +
         packed_.descriptors.total() * packed_.descriptors.elemSize();
}

FeatureMemory::FeatureMemory(const FrameSource& source, const FeatureExtractor& extractor,
                             std::size_t bytes, cv::Mat mask)
    : source_(source),
      extractor_(extractor),
      mask_(std::move(mask)),
      held_(bytes, [](const Held& features) { return features->bytes(); }) {
  // The pool of threads is made while there is one thread: where one of several fails to make it,
  // for want of memory, the others wait for it for ever.
  if (cv::getNumThreads() > 1) cv::parallel_for_(cv::Range(0, 2), [](const cv::Range&) {});
}

FeatureMemory::Held FeatureMemory::extract(std::size_t frame) {
  return extracted_.measure([&] {
    return std::make_shared<const PackedFeatures>(extractor_.extract(source_.image(frame), mask_));
  });
}

FeatureMemory::Held FeatureMemory::of(std::size_t frame) {
  return held_.of(frame, [this, frame] { return extract(frame); });
}

void FeatureMemory::announce(std::size_t frame) {
  if (cv::getNumThreads() < 2) return;
  held_.start(frame, [this, frame] {
    // Inside a loop of OpenCV its inner ones take no further threads.
    Held features;
    cv::parallel_for_(cv::Range(0, 1), [&](const cv::Range&) { features = extract(frame); });
    return features;
  });
}

}  // namespace fathom
