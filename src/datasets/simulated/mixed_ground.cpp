#include <numbers>

#include "ripples.hpp"

namespace fathom {
namespace {

// Sand ripples that wander, fork and fade, and dark patches. Nothing repeats.
class MixedGround : public Ground {
 public:
  MixedGround(cv::Size size, double metres_per_pixel, RandomStream& stream)
      : Ground(metres_per_pixel),
        heading_rad_(stream.uniform(-0.6, 0.6) + std::numbers::pi / 2.0),
        long_ripples_(size, metres_per_pixel, stream.uniform(0.16, 0.22), heading_rad_,
                      {{2.3, 3.2F}, {0.7, 1.2F}, {0.21, 0.35F}}, stream),
        short_ripples_(size, metres_per_pixel, stream.uniform(0.09, 0.12),
                       heading_rad_ + stream.uniform(0.2, 0.5),
                       {{2.3, 3.2F}, {0.7, 1.2F}, {0.21, 0.35F}}, stream),
        train_(size, metres_per_pixel, {{1.9, 1.0F}, {0.5, 0.5F}}, stream),
        strength_(size, metres_per_pixel, {{2.9, 0.6F}, {0.8, 0.3F}}, stream),
        bumps_(size, metres_per_pixel, {{0.35, 0.006F}, {0.09, 0.0025F}, {0.03, 0.0012F}}, stream),
        patches_(size, metres_per_pixel, {{1.7, 0.8F}, {0.45, 0.45F}, {0.12, 0.3F}, {0.04, 0.15F}},
                 stream),
        grain_(size, metres_per_pixel, {{0.15, 3.5F}, {0.04, 4.0F}, {0.018, 6.0F}, {0.008, 8.0F}},
               stream) {}

 private:
  void heights(int row, Row& out) const override {
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

  void surface(int row, Row& grey, Row& slope_gain) const override {
    Row patch(grey.size());
    patches_.row(row, patch);
    grain_.row(row, grey);
    for (std::size_t i = 0; i < grey.size(); ++i) {
      const float dark = smooth_step(0.55F, 1.25F, patch[i]);
      grey[i] = 138.0F - 48.0F * dark + 5.0F * patch[i] + grey[i] * (1.0F + 0.5F * dark);
      // Algae soften the relief below them.
      slope_gain[i] = 0.55F - 0.3F * dark;
    }
  }

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

std::unique_ptr<Ground> mixed_ground(cv::Size size, double metres_per_pixel, RandomStream& stream) {
  return std::make_unique<MixedGround>(size, metres_per_pixel, stream);
}

}  // namespace fathom
