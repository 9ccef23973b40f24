#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "fathom/vision/camera.hpp"
#include "sample.hpp"

namespace fathom {

/// A picture as it is laid on its box, a part of a map. Rows and columns are the box's.
struct LaidPicture {
  const Camera& camera;
  const cv::Mat& source;  ///< the picture, perhaps reduced
  const cv::Mat& broad;   ///< its broad band, in cells; empty without seams
  double per_width;       ///< 1 over the picture's own size
  double per_height;
  Stance stance;
  Eigen::Vector2d corner;  ///< of the box's first pixel, in the body frame
  Eigen::Vector2d per_column;
  Eigen::Vector2d per_row;
  float gain;

  bool has_seams() const { return !broad.empty(); }

  /// Of the picture's own size.
  Eigen::Vector2d pixel_at(int row, int column) const {
    return camera.pixel(corner + column * per_column + row * per_row, stance);
  }
};

// 1 in the middle of the picture, 0 at its border, which `place` runs over from 0 to 1.
inline float tent(double place) {
  return static_cast<float>(1.0 - std::abs(2.0 * place - 1.0));
}

// Of the weights of two pictures the larger one counts alone, but where they differ by less than a
// seventh: the seam. The least is one that a float still holds.
inline float seam_weight(float share) {
  share = std::max(1e-2F, share);
  share *= share;  // ²
  share *= share;  // ⁴
  share *= share;  // ⁸
  return share * share;
}

/// The weights of columns of a span, whose pixels of the picture begin with `first`. All of them,
/// so that the compiler knows how many.
template <int kCount>
std::array<float, kCount> shares_of(const LaidPicture& laid, const Eigen::Vector2d& first,
                                    const Eigen::Vector2d& step) {
  std::array<float, kCount> shares;
  for (int i = 0; i < kCount; ++i) {
    const double u = (first.x() + i * step.x() + 0.5) * laid.per_width;
    const double v = (first.y() + i * step.y() + 0.5) * laid.per_height;
    // Never quite zero, so that a picture's border shows where it is alone.
    shares[i] = std::max(1e-3F, tent(u)) * std::max(1e-3F, tent(v));
  }
  return shares;
}

/// Places in the picture, in its pixels, of columns of a span.
template <int kCount>
struct Places {
  std::array<double, kCount> u;
  std::array<double, kCount> v;
};

/// Where a pixel of the picture's own size lies in `source`, the same in other pixels.
inline Eigen::Vector2d place_in(const cv::Mat& source, const LaidPicture& laid,
                                const Eigen::Vector2d& pixel) {
  return {(pixel.x() + 0.5) * (laid.per_width * source.cols) - 0.5,
          (pixel.y() + 0.5) * (laid.per_height * source.rows) - 0.5};
}

template <int kCount>
Places<kCount> places_of(const LaidPicture& laid, const Eigen::Vector2d& first,
                         const Eigen::Vector2d& step) {
  Places<kCount> at;
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector2d place = place_in(laid.source, laid, first + i * step);
    at.u[i] = place.x();
    at.v[i] = place.y();
  }
  return at;
}

/// Grey levels of columns that all have four pixels of the picture around them, in loops that the
/// compiler does side by side.
template <int kCount>
std::array<float, kCount> greys_within(const cv::Mat& source, const Places<kCount>& at) {
  std::array<int, kCount> columns;
  std::array<int, kCount> rows;
  std::array<float, kCount> fu;
  std::array<float, kCount> fv;
  for (int i = 0; i < kCount; ++i) {
    columns[i] = static_cast<int>(at.u[i]);
    rows[i] = static_cast<int>(at.v[i]);
    fu[i] = static_cast<float>(at.u[i] - columns[i]);
    fv[i] = static_cast<float>(at.v[i] - rows[i]);
  }
  std::array<float, kCount> greys;
  for (int i = 0; i < kCount; ++i) {
    greys[i] = bilinear(source.ptr<float>(rows[i]), source.ptr<float>(rows[i] + 1), columns[i],
                        columns[i] + 1, fu[i], fv[i]);
  }
  return greys;
}

/// Grey levels of columns [begin, end).
template <int kCount>
std::array<float, kCount> greys_of(const LaidPicture& laid, const Eigen::Vector2d& first,
                                   const Eigen::Vector2d& step, int begin, int end) {
  const Places<kCount> at = places_of<kCount>(laid, first, step);
  const auto is_within = [&](int i) {
    return at.u[i] >= 0.0 && at.u[i] < laid.source.cols - 1.0 && at.v[i] >= 0.0 &&
           at.v[i] < laid.source.rows - 1.0;
  };
  // A span lies on a line.
  if (is_within(0) && is_within(kCount - 1)) return greys_within<kCount>(laid.source, at);
  std::array<float, kCount> greys{};
  for (int i = begin; i < end; ++i) greys[i] = sample(laid.source, at.u[i], at.v[i]);
  return greys;
}

/// Sums of grey, each weighted, and of the weights; from a pixel on.
struct WeightedSums {
  float* sum = nullptr;
  float* weight = nullptr;
};

/// `broad` with seams alone.
struct BandSums {
  WeightedSums fine;
  WeightedSums broad;

  BandSums from(int column) const {
    BandSums later{{fine.sum + column, fine.weight + column}, {}};
    if (broad.sum != nullptr) later.broad = {broad.sum + column, broad.weight + column};
    return later;
  }
};

/// Adds columns [begin, end) of kCount.
template <int kCount>
void add_feathered(const LaidPicture& laid, const Eigen::Vector2d& first,
                   const Eigen::Vector2d& step, int begin, int end, const WeightedSums& sums) {
  const std::array<float, kCount> shares = shares_of<kCount>(laid, first, step);
  const std::array<float, kCount> greys = greys_of<kCount>(laid, first, step, begin, end);
  for (int i = begin; i < end; ++i) {
    sums.sum[i - begin] += shares[i] * laid.gain * greys[i];
    sums.weight[i - begin] += shares[i];
  }
}

/// The same in two bands: the broad one feathered, what is left of the picture with weights that
/// make seams.
template <int kCount>
void add_bands(const LaidPicture& laid, const Eigen::Vector2d& first, const Eigen::Vector2d& step,
               int begin, int end, const BandSums& sums) {
  const std::array<float, kCount> shares = shares_of<kCount>(laid, first, step);
  const auto broad_at = [&](const Eigen::Vector2d& pixel) {
    const Eigen::Vector2d place = place_in(laid.broad, laid, pixel);
    return laid.gain * sample(laid.broad, place.x(), place.y());
  };
  // The band is smooth, so that a line over the span will do: what it leaves out is in the other.
  const float first_grey = broad_at(first);
  const float per_column = (broad_at(first + kCount * step) - first_grey) / kCount;
  std::array<float, kCount> broad;
  std::array<float, kCount> at_seam;
  for (int i = 0; i < kCount; ++i) {
    broad[i] = first_grey + static_cast<float>(i) * per_column;
    at_seam[i] = seam_weight(shares[i]);
  }
  bool is_shown = false;
  for (int i = begin; i < end; ++i) {
    sums.broad.sum[i - begin] += shares[i] * broad[i];
    sums.broad.weight[i - begin] += shares[i];
    // Away from the seams it would not show.
    if (at_seam[i] * 512.0F < sums.fine.weight[i - begin]) at_seam[i] = 0.0F;
    is_shown = is_shown || at_seam[i] > 0.0F;
  }
  if (!is_shown) return;
  const std::array<float, kCount> greys = greys_of<kCount>(laid, first, step, begin, end);
  for (int i = begin; i < end; ++i) {
    sums.fine.sum[i - begin] += at_seam[i] * (laid.gain * greys[i] - broad[i]);
    sums.fine.weight[i - begin] += at_seam[i];
  }
}

template <int kCount>
void add_pixels(const LaidPicture& laid, const Eigen::Vector2d& first, const Eigen::Vector2d& step,
                int begin, int end, const BandSums& sums) {
  if (laid.has_seams()) {
    add_bands<kCount>(laid, first, step, begin, end, sums);
  } else {
    add_feathered<kCount>(laid, first, step, begin, end, sums.fine);
  }
}

}  // namespace fathom
