#include "ripples.hpp"

#include <cmath>
#include <numbers>

namespace fathom {
namespace {

double wave_number(double wavelength_m, double metres_per_pixel) {
  return 2.0 * std::numbers::pi * metres_per_pixel / wavelength_m;
}

}  // namespace

Ripples::Ripples(cv::Size size, double metres_per_pixel, double wavelength_m, double heading_rad,
                 std::initializer_list<Octave> astray_rad, RandomStream& stream)
    : astray_(size, metres_per_pixel, astray_rad, stream),
      per_column_(
          static_cast<float>(wave_number(wavelength_m, metres_per_pixel) * std::cos(heading_rad))),
      per_row_(wave_number(wavelength_m, metres_per_pixel) * std::sin(heading_rad)) {}

void Ripples::row(int row, Row& out) const {
  astray_.row(row, out);
  const auto start = static_cast<float>(std::fmod(per_row_ * row, 2.0 * std::numbers::pi));
  for (std::size_t column = 0; column < out.size(); ++column) {
    const float phase = out[column] + start + per_column_ * static_cast<float>(column);
    const float wave = std::sin(phase);
    out[column] = wave + 0.35F * wave * wave - 0.175F;
  }
}

}  // namespace fathom
