// Grounds without ripples: mottled, with bumps.

#include <initializer_list>

#include "ground.hpp"
#include "noise_field.hpp"

namespace fathom {
namespace {

struct Look {
  float grey;
  std::initializer_list<Octave> bumps_m;
  std::initializer_list<Octave> mottle;  ///< grey levels
};

class PlainGround : public Ground {
 public:
  PlainGround(cv::Size size, double metres_per_pixel, const Look& look, RandomStream& stream)
      : Ground(metres_per_pixel),
        grey_(look.grey),
        bumps_(size, metres_per_pixel, look.bumps_m, stream),
        mottle_(size, metres_per_pixel, look.mottle, stream) {}

 private:
  void heights(int row, Row& out) const override { bumps_.row(row, out); }

  void surface(int row, Row& grey, Row& slope_gain) const override {
    mottle_.row(row, grey);
    for (float& value : grey) value += grey_;
    std::fill(slope_gain.begin(), slope_gain.end(), 0.55F);
  }

  float grey_;
  Relief bumps_;
  Relief mottle_;
};

// Sand with patches of algae, which are dark, ragged and rough.
class PatchyGround : public Ground {
 public:
  PatchyGround(cv::Size size, double metres_per_pixel, RandomStream& stream)
      : Ground(metres_per_pixel),
        bumps_(size, metres_per_pixel, {{0.5, 0.006F}, {0.12, 0.002F}, {0.03, 0.0008F}}, stream),
        patches_(size, metres_per_pixel, {{1.1, 0.9F}, {0.35, 0.5F}, {0.1, 0.35F}, {0.03, 0.2F}},
                 stream),
        grain_(size, metres_per_pixel, {{0.15, 2.0F}, {0.04, 3.0F}, {0.018, 4.0F}, {0.008, 5.0F}},
               stream) {}

 private:
  void heights(int row, Row& out) const override { bumps_.row(row, out); }

  void surface(int row, Row& grey, Row& slope_gain) const override {
    Row patch(grey.size());
    patches_.row(row, patch);
    grain_.row(row, grey);
    for (std::size_t i = 0; i < grey.size(); ++i) {
      const float algae = smooth_step(0.2F, 0.8F, patch[i]);
      grey[i] = 150.0F - 78.0F * algae + 4.0F * patch[i] + grey[i] * (1.0F + 0.8F * algae);
      slope_gain[i] = 0.55F - 0.35F * algae;
    }
  }

  Relief bumps_;
  Relief patches_;
  Relief grain_;
};

}  // namespace

std::unique_ptr<Ground> muddy_ground(cv::Size size, double metres_per_pixel, RandomStream& stream) {
  return std::make_unique<PlainGround>(
      size, metres_per_pixel,
      Look{112.0F,
           {{0.6, 0.005F}, {0.2, 0.0015F}},
           {{1.1, 3.0F}, {0.3, 3.0F}, {0.09, 2.0F}, {0.03, 1.5F}, {0.014, 2.2F}}},
      stream);
}

std::unique_ptr<Ground> sandy_ground(cv::Size size, double metres_per_pixel, RandomStream& stream) {
  return std::make_unique<PlainGround>(
      size, metres_per_pixel,
      Look{140.0F,
           {{0.35, 0.006F}, {0.09, 0.0025F}, {0.03, 0.0012F}},
           {{1.3, 4.0F}, {0.15, 3.5F}, {0.04, 4.0F}, {0.018, 5.0F}, {0.008, 6.0F}}},
      stream);
}

std::unique_ptr<Ground> patchy_ground(cv::Size size, double metres_per_pixel,
                                      RandomStream& stream) {
  return std::make_unique<PatchyGround>(size, metres_per_pixel, stream);
}

}  // namespace fathom
