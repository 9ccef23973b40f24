#include "fathom/datasets/sea_floor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "fathom/core/random.hpp"
#include "noise_field.hpp"
#include "stones.hpp"

namespace fathom {
namespace {

using Row = std::vector<float>;

float smooth_step(float low, float high, float value) {
  const float t = std::clamp((value - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

// One train of ripples. Its phase is a plane wave's, led astray by a relief of several radians, so
// that crests wander and never come back to their spacing.
class Ripples {
 public:
  Ripples(cv::Size size, double metres_per_pixel, double wavelength_m, double heading_rad,
          RandomStream& stream)
      : astray_(size, metres_per_pixel, {{2.3, 3.2F}, {0.7, 1.2F}, {0.21, 0.35F}}, stream),
        per_column_(static_cast<float>(wave_number(wavelength_m, metres_per_pixel) *
                                       std::cos(heading_rad))),
        per_row_(wave_number(wavelength_m, metres_per_pixel) * std::sin(heading_rad)) {}

  // Height in [−1, 1] or so: crests narrower than troughs, as on sand.
  void row(int row, Row& out) const {
    astray_.row(row, out);
    const auto start = static_cast<float>(std::fmod(per_row_ * row, 2.0 * std::numbers::pi));
    for (std::size_t column = 0; column < out.size(); ++column) {
      const float phase = out[column] + start + per_column_ * static_cast<float>(column);
      const float wave = std::sin(phase);
      out[column] = wave + 0.35F * wave * wave - 0.175F;
    }
  }

 private:
  static double wave_number(double wavelength_m, double metres_per_pixel) {
    return 2.0 * std::numbers::pi * metres_per_pixel / wavelength_m;
  }

  Relief astray_;
  float per_column_;
  double per_row_;
};

class SeaFloor {
 public:
  SeaFloor(cv::Size size, double metres_per_pixel, RandomStream& stream)
      : metres_per_pixel_(metres_per_pixel),
        heading_rad_(stream.uniform(-0.6, 0.6) + std::numbers::pi / 2.0),
        long_ripples_(size, metres_per_pixel, stream.uniform(0.16, 0.22), heading_rad_, stream),
        short_ripples_(size, metres_per_pixel, stream.uniform(0.09, 0.12),
                       heading_rad_ + stream.uniform(0.2, 0.5), stream),
        train_(size, metres_per_pixel, {{1.9, 1.0F}, {0.5, 0.5F}}, stream),
        strength_(size, metres_per_pixel, {{2.9, 0.6F}, {0.8, 0.3F}}, stream),
        bumps_(size, metres_per_pixel, {{0.35, 0.006F}, {0.09, 0.0025F}, {0.03, 0.0012F}}, stream),
        patches_(size, metres_per_pixel, {{1.7, 0.8F}, {0.45, 0.45F}, {0.12, 0.3F}, {0.04, 0.15F}},
                 stream),
        grain_(size, metres_per_pixel, {{0.15, 3.5F}, {0.04, 4.0F}, {0.018, 6.0F}, {0.008, 8.0F}},
               stream) {}

  void draw(cv::Mat& picture, const cv::Range& rows) const {
    const auto width = static_cast<std::size_t>(picture.cols);
    Row above_m(width);
    Row height_m(width);
    Row patch(width);
    Row grain(width);
    heights(rows.start - 1 < 0 ? 0 : rows.start - 1, above_m);
    for (int row = rows.start; row < rows.end; ++row) {
      heights(row, height_m);
      patches_.row(row, patch);
      grain_.row(row, grain);
      uchar* out = picture.ptr(row);
      for (std::size_t i = 0; i < width; ++i) {
        const float left_m = height_m[i > 0 ? i - 1 : 0];
        // Light from the upper left: slopes that face it are bright.
        const float slope =
            (2.0F * height_m[i] - left_m - above_m[i]) / static_cast<float>(metres_per_pixel_);
        out[i] = grey(slope, patch[i], grain[i]);
      }
      std::swap(above_m, height_m);
    }
  }

 private:
  void heights(int row, Row& out) const {
    Row other(out.size());
    Row blend(out.size());
    long_ripples_.row(row, out);
    short_ripples_.row(row, other);
    train_.row(row, blend);
    // Where one train takes over from the other, crests fork.
    for (std::size_t i = 0; i < out.size(); ++i) {
      const float share = smooth_step(0.1F, 0.9F, blend[i]);
      out[i] = 0.011F * out[i] * (1.0F - share) + 0.006F * other[i] * share;
    }
    strength_.row(row, blend);
    bumps_.row(row, other);
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] = out[i] * smooth_step(-1.0F, 0.7F, blend[i]) + other[i];
    }
  }

  static uchar grey(float slope, float patch, float grain) {
    const float dark = smooth_step(0.55F, 1.25F, patch);
    const float albedo = 138.0F - 48.0F * dark + 5.0F * patch + grain * (1.0F + 0.5F * dark);
    // Algae soften the relief below them.
    const float light = 1.0F + (0.55F - 0.3F * dark) * slope;
    return static_cast<uchar>(std::clamp(albedo * light, 0.0F, 255.0F));
  }

  double metres_per_pixel_;
  double heading_rad_;
  Ripples long_ripples_;
  Ripples short_ripples_;
  Relief train_;
  Relief strength_;
  Relief bumps_;
  Relief patches_;
  Relief grain_;
};

}  // namespace

cv::Mat draw_sea_floor(cv::Size size, double metres_per_pixel, std::uint64_t seed) {
  RandomStream relief_stream(seed, "relief");
  RandomStream stone_stream(seed, "stones");
  const SeaFloor floor(size, metres_per_pixel, relief_stream);
  cv::Mat picture(size, CV_8UC1);
  cv::parallel_for_(cv::Range(0, size.height),
                    [&](const cv::Range& rows) { floor.draw(picture, rows); });
  strew_stones(picture, metres_per_pixel, stone_stream);
  return picture;
}

}  // namespace fathom
