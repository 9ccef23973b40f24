#include "fathom/front_end/feature_memory.hpp"

#include <cstring>
#include <utility>

#include <opencv2/core/utility.hpp>

namespace fathom {
namespace {

/// Before the numbers of packed features as bytes.
struct BytesHead {
  std::int32_t type = 0;  ///< of the descriptors, unpacked
  std::int32_t packed_type = 0;
  std::int32_t count = 0;
  std::int32_t columns = 0;  ///< of the descriptors
};

constexpr std::int32_t kMostColumns = 4096;

}  // namespace

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

std::string PackedFeatures::to_bytes() const {
  const cv::Mat& descriptors = packed_.descriptors;
  const BytesHead head{type_, descriptors.type(), static_cast<std::int32_t>(packed_.size()),
                       descriptors.cols};
  std::string bytes;
  const auto append = [&bytes](const void* data, std::size_t size) {
    bytes.append(static_cast<const char*>(data), size);
  };
  append(&head, sizeof head);
  for (const Eigen::Vector2d& pixel : packed_.pixels) append(pixel.data(), 2 * sizeof(double));
  append(packed_.sizes_px.data(), packed_.sizes_px.size() * sizeof(float));
  append(packed_.turns_rad.data(), packed_.turns_rad.size() * sizeof(float));
  for (int row = 0; row < descriptors.rows; ++row) {
    append(descriptors.ptr(row), descriptors.elemSize() * static_cast<std::size_t>(head.columns));
  }
  return bytes;
}

std::optional<PackedFeatures> PackedFeatures::from_bytes(std::string_view bytes) {
  BytesHead head;
  if (bytes.size() < sizeof head) return std::nullopt;
  std::memcpy(&head, bytes.data(), sizeof head);
  bytes.remove_prefix(sizeof head);
  const auto is_type = [](int type) { return type == CV_8U || type == CV_32F; };
  if (!is_type(head.type) || !is_type(head.packed_type)) return std::nullopt;
  if (head.count < 0 || head.columns < 0 || head.columns > kMostColumns) return std::nullopt;
  const auto count = static_cast<std::size_t>(head.count);
  const std::size_t row = static_cast<std::size_t>(head.columns) * CV_ELEM_SIZE(head.packed_type);
  if (bytes.size() != count * (2 * sizeof(double) + 2 * sizeof(float) + row)) return std::nullopt;
  PackedFeatures features;
  features.type_ = head.type;
  Features& packed = features.packed_;
  const auto take = [&bytes](void* data, std::size_t size) {
    if (size == 0) return;
    std::memcpy(data, bytes.data(), size);
    bytes.remove_prefix(size);
  };
  packed.pixels.resize(count);
  for (Eigen::Vector2d& pixel : packed.pixels) take(pixel.data(), 2 * sizeof(double));
  packed.sizes_px.resize(count);
  take(packed.sizes_px.data(), count * sizeof(float));
  packed.turns_rad.resize(count);
  take(packed.turns_rad.data(), count * sizeof(float));
  if (count > 0) packed.descriptors.create(head.count, head.columns, head.packed_type);
  take(packed.descriptors.data, count * row);
  return features;
}

FeatureMemory::FeatureMemory(FeatureSource source, std::size_t bytes)
    : source_(std::move(source)),
      held_(bytes, [](const Held& features) { return features->bytes(); }) {
  // The pool of threads is made while there is one thread: where one of several fails to make it,
  // for want of memory, the others wait for it for ever.
  if (cv::getNumThreads() > 1) cv::parallel_for_(cv::Range(0, 2), [](const cv::Range&) {});
}

FeatureMemory::Held FeatureMemory::extract(std::size_t frame) {
  return extracted_.measure([&] {
    return std::make_shared<const PackedFeatures>(
        source_.extractor.extract(source_.pictures.image(frame), source_.mask));
  });
}

FeatureMemory::Held FeatureMemory::make(std::size_t frame) {
  if (source_.cache == nullptr) return extract(frame);
  const RegistrationKey key = source_.keys.of(source_.pictures.picture_id(frame));
  if (const auto bytes = source_.cache->find(key)) {
    if (auto kept = PackedFeatures::from_bytes(*bytes)) {
      return std::make_shared<const PackedFeatures>(*std::move(kept));
    }
  }
  Held made = extract(frame);
  source_.cache->put(key, made->to_bytes());
  return made;
}

FeatureMemory::Held FeatureMemory::of(std::size_t frame) {
  return held_.of(frame, [this, frame] { return make(frame); });
}

void FeatureMemory::announce(std::size_t frame) {
  if (cv::getNumThreads() < 2) return;
  held_.start(frame, [this, frame] {
    // Inside a loop of OpenCV its inner ones take no further threads.
    Held features;
    cv::parallel_for_(cv::Range(0, 1), [&](const cv::Range&) { features = make(frame); });
    return features;
  });
}

}  // namespace fathom
