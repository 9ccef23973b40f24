#include "height_field.hpp"

#include <algorithm>
#include <cmath>

#include "fathom/core/random.hpp"
#include "noise_field.hpp"

namespace fathom {

float HeightField::at(const Eigen::Vector2f& point) const {
  const auto cells = static_cast<float>(1.0 / metres_per_cell);
  const float column = (static_cast<float>(first_m.y()) - point.y()) * cells;
  const float row = (static_cast<float>(first_m.x()) - point.x()) * cells;
  const float u = std::clamp(column, 0.0F, static_cast<float>(heights_m.cols - 1));
  const float v = std::clamp(row, 0.0F, static_cast<float>(heights_m.rows - 1));
  const int left = std::min(static_cast<int>(u), std::max(heights_m.cols - 2, 0));
  const int top = std::min(static_cast<int>(v), std::max(heights_m.rows - 2, 0));
  const int right = std::min(left + 1, heights_m.cols - 1);
  const float fu = u - static_cast<float>(left);
  const float fv = v - static_cast<float>(top);
  const float* upper = heights_m[top];
  const float* lower = heights_m[std::min(top + 1, heights_m.rows - 1)];
  const float above = upper[left] + fu * (upper[right] - upper[left]);
  const float below = lower[left] + fu * (lower[right] - lower[left]);
  return above + fv * (below - above);
}

HeightField draw_relief(const Eigen::AlignedBox2d& box, double highest_m, std::uint64_t seed) {
  // A fifteenth of the shortest wavelength: bilinear is then good to half a per cent.
  constexpr double kMetresPerCell = 0.02;
  const auto cells = [&](double length_m) {
    return static_cast<int>(std::ceil(length_m / kMetresPerCell)) + 1;
  };
  HeightField field;
  field.metres_per_cell = kMetresPerCell;
  field.first_m = box.max();
  const cv::Size size(cells(box.sizes().y()), cells(box.sizes().x()));
  field.heights_m.create(size);
  RandomStream stream(seed, "heights");
  // A field of cells has its detail at twice their size.
  const Relief relief(size, kMetresPerCell, {{0.75, 1.0F}, {0.35, 0.4F}, {0.15, 0.12F}}, stream);
  std::vector<float> row(static_cast<std::size_t>(size.width));
  for (int i = 0; i < size.height; ++i) {
    relief.row(i, row);
    std::copy(row.begin(), row.end(), field.heights_m[i]);
  }
  field.heights_m -= cv::mean(field.heights_m)[0];
  const double farthest = cv::norm(field.heights_m, cv::NORM_INF);
  if (farthest > 0.0) field.heights_m *= highest_m / farthest;
  return field;
}

}  // namespace fathom
