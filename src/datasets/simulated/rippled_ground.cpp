#include <numbers>

#include "ripples.hpp"

namespace fathom {
namespace {

// One train of constant wavelength and heading whose crests hardly wander, under a faint grain:
// seen by its ripples alone, every place looks like the next one a wavelength on.
class RippledGround : public Ground {
 public:
  RippledGround(cv::Size size, double metres_per_pixel, RandomStream& stream)
      : Ground(metres_per_pixel),
        wavelength_m_(stream.uniform(0.14, 0.18)),
        heading_rad_(stream.uniform(0.0, std::numbers::pi)),
        ripples_(size, metres_per_pixel, wavelength_m_, heading_rad_, {{3.1, 0.35F}, {0.9, 0.15F}},
                 stream),
        bumps_(size, metres_per_pixel, {{0.09, 0.0008F}, {0.03, 0.0004F}}, stream),
        grain_(size, metres_per_pixel, {{0.15, 1.0F}, {0.04, 1.5F}, {0.018, 2.5F}, {0.008, 4.0F}},
               stream) {}

 private:
  void heights(int row, Row& out) const override {
    Row bumps(out.size());
    ripples_.row(row, out);
    bumps_.row(row, bumps);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = 0.009F * out[i] + bumps[i];
  }

  void surface(int row, Row& grey, Row& slope_gain) const override {
    grain_.row(row, grey);
    for (float& value : grey) value += 138.0F;
    std::fill(slope_gain.begin(), slope_gain.end(), 0.55F);
  }

  double wavelength_m_;
  double heading_rad_;
  Ripples ripples_;
  Relief bumps_;
  Relief grain_;
};

}  // namespace

std::unique_ptr<Ground> rippled_ground(cv::Size size, double metres_per_pixel,
                                       RandomStream& stream) {
  return std::make_unique<RippledGround>(size, metres_per_pixel, stream);
}

}  // namespace fathom
