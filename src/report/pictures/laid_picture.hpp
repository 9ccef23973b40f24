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
  double per_width;       ///< 1 over the picture's own size
  double per_height;
  Stance stance;
  Eigen::Vector2d corner;  ///< of the box's first pixel, in the body frame
  Eigen::Vector2d per_column;
  Eigen::Vector2d per_row;
  float gain;
  bool has_seams;

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
  if (laid.has_seams) {
    for (int i = 0; i < kCount; ++i) shares[i] = seam_weight(shares[i]);
  }
  return shares;
}

/// Places in the picture, in its pixels, of columns of a span.
template <int kCount>
struct Places {
  std::array<double, kCount> u;
  std::array<double, kCount> v;
};

template <int kCount>
Places<kCount> places_of(const LaidPicture& laid, const Eigen::Vector2d& first,
                         const Eigen::Vector2d& step) {
  const double columns_per_pixel = laid.per_width * laid.source.cols;
  const double rows_per_pixel = laid.per_height * laid.source.rows;
  Places<kCount> at;
  for (int i = 0; i < kCount; ++i) {
    at.u[i] = (first.x() + i * step.x() + 0.5) * columns_per_pixel - 0.5;
    at.v[i] = (first.y() + i * step.y() + 0.5) * rows_per_pixel - 0.5;
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

/// Adds columns [begin, end) of kCount; `sum` and `weight` count from `begin`.
template <int kCount>
void add_pixels(const LaidPicture& laid, const Eigen::Vector2d& first, const Eigen::Vector2d& step,
                int begin, int end, float* sum, float* weight) {
  std::array<float, kCount> shares = shares_of<kCount>(laid, first, step);
  bool are_nothing = laid.has_seams;
  if (laid.has_seams) {
    for (int i = begin; i < end; ++i) {
      // Away from the seams it would not show.
      if (shares[i] * 512.0F < weight[i - begin]) shares[i] = 0.0F;
      are_nothing = are_nothing && shares[i] == 0.0F;
    }
  }
  if (are_nothing) return;
  const Places<kCount> at = places_of<kCount>(laid, first, step);
  const auto is_within = [&](int i) {
    return at.u[i] >= 0.0 && at.u[i] < laid.source.cols - 1.0 && at.v[i] >= 0.0 &&
           at.v[i] < laid.source.rows - 1.0;
  };
  // A span lies on a line.
  const bool are_within = is_within(0) && is_within(kCount - 1);
  std::array<float, kCount> greys;
  if (are_within) {
    greys = greys_within<kCount>(laid.source, at);
  } else {
    for (int i = begin; i < end; ++i) greys[i] = sample(laid.source, at.u[i], at.v[i]);
  }
  for (int i = begin; i < end; ++i) {
    sum[i - begin] += shares[i] * laid.gain * greys[i];
    weight[i - begin] += shares[i];
  }
}

}  // namespace fathom
