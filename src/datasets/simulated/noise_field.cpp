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
  for (auto& weights : weights_) weights.reserve(static_cast<std::size_t>(size.width));
  for (int column = 0; column < size.width; ++column) {
    const Place at = place(column);
    if (cells_.empty() || cells_.back().first != at.first) cells_.push_back({at.first, column});
    cells_.back().end = column + 1;
    for (std::size_t k = 0; k < 4; ++k) weights_[k].push_back(at.weights[k]);
  }
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
  int column = 0;
  for (const Cell& cell : cells_) {
    add_cell(blended.data() + cell.first, column, cell.end, out);
    column = cell.end;
  }
}

void NoiseField::add_cell(const float* points, int begin, int end, float* __restrict out) const {
  const float a = points[0];
  const float b = points[1];
  const float c = points[2];
  const float d = points[3];
  const float* w0 = weights_[0].data();
  const float* w1 = weights_[1].data();
  const float* w2 = weights_[2].data();
  const float* w3 = weights_[3].data();
  const auto add = [&](int i) { out[i] += w0[i] * a + w1[i] * b + w2[i] * c + w3[i] * d; };
  constexpr int kLanes = 4;
  int i = begin;
  for (; i + kLanes <= end; i += kLanes) {
    for (int k = 0; k < kLanes; ++k) add(i + k);
  }
  for (; i < end; ++i) add(i);
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
