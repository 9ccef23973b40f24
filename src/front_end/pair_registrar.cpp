#include "fathom/front_end/pair_registrar.hpp"

#include <algorithm>
#include <bit>
#include <exception>
#include <future>
#include <system_error>

#include <opencv2/core/utility.hpp>

#include "fathom/core/input_error.hpp"
#include "fathom/front_end/pair_seed.hpp"
#include "fathom/vision/registration.hpp"

namespace fathom {
namespace {

// Calls work(0) … work(count − 1), which must not throw, on as many threads as OpenCV may use. Its
// own loop would run on one as long as features are extracted in the background.
template <class Work>
void in_parallel(std::size_t count, const Work& work) {
  std::atomic<std::size_t> next = 0;
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  const std::size_t threads = std::min(PairRegistrar::look_ahead(), count);
  std::vector<std::future<void>> others;
  others.reserve(threads);
  try {
    while (others.size() + 1 < threads) others.push_back(std::async(std::launch::async, run));
  } catch (const std::system_error&) {
    // The system has no further thread: fewer do the same work.
  }
  run();
}

}  // namespace

PairRegistrar::PairRegistrar(const FrameSource& pictures, const FeatureOptions& features,
                             const RegistrationOptions& registration, std::uint64_t seed,
                             RegistrationCache* cache, std::size_t feature_bytes,
                             const PictureUse& use)
    : pictures_(pictures),
      options_(registration),
      seed_(seed),
      cache_(cache),
      keys_(pictures.camera().model(), features, registration, use.mask),
      use_(use),
      features_({pictures, FeatureExtractor(features, registration.tuning.features), use.mask,
                 cache == nullptr ? nullptr : cache->pictures(),
                 FeatureKeys(features, registration.tuning.features, use.mask)},
                feature_bytes) {}

PairRegistrar::FrameKey PairRegistrar::frame_key(const MeasuredFrame& frame) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  const MeasuredTilt measured = frame.tilt.value_or(MeasuredTilt{});
  return {frame.frame,
          bits(frame.altitude_m),
          bits(frame.altitude_sigma_m),
          frame.tilt.has_value(),
          bits(measured.tilt.roll_rad),
          bits(measured.tilt.pitch_rad),
          bits(measured.sigma_rad)};
}

PairRegistrar::PairKey PairRegistrar::pair_key(const MeasuredFrame& from, const MeasuredFrame& to) {
  return {frame_key(from), frame_key(to)};
}

std::uint64_t PairRegistrar::seed_of(const MeasuredFrame& from, const MeasuredFrame& to) const {
  return pair_seed(seed_, from.frame, to.frame);
}

RegistrationKey PairRegistrar::cache_key(const MeasuredFrame& from, const MeasuredFrame& to) const {
  const auto seen = [this](const MeasuredFrame& one) {
    return SeenPicture{pictures_.picture_id(one.frame), one.altitude_m, one.tilt,
                       one.altitude_sigma_m};
  };
  return keys_.of(seen(from), seen(to), seed_of(from, to));
}

std::optional<PairRegistration> PairRegistrar::known(const MeasuredFrame& from,
                                                     const MeasuredFrame& to) {
  if (use_.is_repeated(from.frame) || use_.is_repeated(to.frame)) return PairRegistration{};
  const PairKey pair = pair_key(from, to);
  if (auto value = pairs_.find(pair)) return value;
  if (cache_ == nullptr || pairs_.contains(pair)) return std::nullopt;
  const auto value = cache_->find(cache_key(from, to));
  if (!value) return std::nullopt;
  return pairs_.of(pair, [&] {
    ++from_cache_;
    return *value;
  });
}

FloorFeatures PairRegistrar::on_floor_of(const MeasuredFrame& frame) {
  FloorFeatures features = on_floor(features_.of(frame.frame)->unpacked(), pictures_.camera(),
                                    frame.altitude_m, frame.tilt);
  features.viewpoint.altitude_sigma_m = frame.altitude_sigma_m;
  return features;
}

// Pixels in, registration out: features, their points on the floor, the motion and its covariance.
PairRegistration PairRegistrar::register_anew(const MeasuredFrame& from, const MeasuredFrame& to,
                                              const FloorFeatures& features_to) {
  const FloorFeatures features_from = on_floor_of(from);
  const Registration found = registered_.measure(
      [&] { return register_pair(features_from, features_to, options_, seed_of(from, to)); });
  PairRegistration value{found.found,      found.motion,
                         found.covariance, static_cast<int>(found.inliers.size()),
                         found.shared,     found.own};
  if (cache_ != nullptr) cache_->put(cache_key(from, to), value);
  return value;
}

PairRegistration PairRegistrar::of(const MeasuredFrame& from, const MeasuredFrame& to) {
  if (const auto value = known(from, to)) return *value;
  return pairs_.of(pair_key(from, to), [&] { return register_anew(from, to, on_floor_of(to)); });
}

std::vector<PairRegistration> PairRegistrar::of_all(std::span<const MeasuredFrame> from,
                                                    const MeasuredFrame& to) {
  std::vector<PairRegistration> values(from.size());
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (const auto value = known(from[i], to)) {
      values[i] = *value;
    } else {
      missing.push_back(i);
    }
  }
  if (missing.empty()) return values;

  // All need it. Made here, where it may use all threads; inside the loop all but one would wait.
  const FloorFeatures features_to = on_floor_of(to);
  std::vector<std::exception_ptr> errors(missing.size());
  in_parallel(missing.size(), [&](std::size_t m) {
    const std::size_t i = missing[m];
    try {
      values[i] =
          pairs_.of(pair_key(from[i], to), [&] { return register_anew(from[i], to, features_to); });
    } catch (...) {
      errors[m] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
  return values;
}

std::size_t PairRegistrar::look_ahead() {
  return static_cast<std::size_t>(std::max(cv::getNumThreads(), 1));
}

void PairRegistrar::announce(const MeasuredFrame& from, const MeasuredFrame& to) {
  if (to.frame >= pictures_.size() || pairs_.contains(pair_key(from, to))) return;
  try {
    if (!known(from, to)) features_.announce(to.frame);
  } catch (const InputError&) {
    // A picture cannot be read; who asks for the pair is told.
  }
}

}  // namespace fathom
