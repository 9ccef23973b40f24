#include "noise_field.hpp"

#include <algorithm>
#include <cmath>

namespace fathom {
namespace {

// Weights of the four grid points around a place at `t` in [0, 1) of its cell.
std::array<float, 4> b_spline(float t) {
  const float s = 1.0F - t;
  return {s * s * s / 6.0F, (4.0F - 6.0F * t * t + 3.0F * t * t * t) / 6.0F,
          (4.0F - 6.0F * s * s + 3.0F * s * s * s) / 6.0F, t * t * t / 6.0F};
}

}  // namespace

NoiseField::NoiseField(cv::Size size, double cell_px, RandomStream& stream)
    : cell_px_(cell_px),
      grid_(static_cast<int>(size.height / cell_px) + 5,
            static_cast<int>(size.width / cell_px) + 5) {
  // The spline averages neighbours: of unit noise it leaves a mean variance of 151/315 along each
  // axis (the sum of its squared weights, averaged over a cell).
  constexpr double kAxisVariance = 151.0 / 315.0;
  const double half_width = std::sqrt(3.0) / kAxisVariance;
  for (float& value : grid_) value = static_cast<float>(stream.uniform(-half_width, half_width));
  for (int column = 0; column < size.width; ++column) columns_.push_back(place(column));
}

NoiseField::Place NoiseField::place(int pixel) const {
  const double at = pixel / cell_px_;
  const double cell = std::floor(at);
  return {static_cast<int>(cell), b_spline(static_cast<float>(at - cell))};
}

void NoiseField::add_row(int row, float gain, float* out) const {
  const Place vertical = place(row);
  std::vector<float> blended(static_cast<std::size_t>(grid_.cols));
  for (std::size_t k = 0; k < 4; ++k) {
    const float* source = grid_[vertical.first + static_cast<int>(k)];
    const float weight = gain * vertical.weights[k];
    for (int i = 0; i < grid_.cols; ++i) blended[static_cast<std::size_t>(i)] += weight * source[i];
  }
  for (const Place& column : columns_) {
    const float* at = blended.data() + column.first;
    const auto& w = column.weights;
    *out++ += w[0] * at[0] + w[1] * at[1] + w[2] * at[2] + w[3] * at[3];
  }
}

Relief::Relief(cv::Size size, double metres_per_pixel, std::initializer_list<Octave> octaves,
               RandomStream& stream) {
  for (const Octave& octave : octaves) {
    const double cell_px = octave.cell_m / metres_per_pixel;
    if (cell_px < 1.0) continue;
    fields_.emplace_back(size, cell_px, stream);
    gains_.push_back(octave.gain);
  }
}

void Relief::row(int row, std::vector<float>& out) const {
  std::fill(out.begin(), out.end(), 0.0F);
  for (std::size_t i = 0; i < fields_.size(); ++i) fields_[i].add_row(row, gains_[i], out.data());
}

}  // namespace fathom
