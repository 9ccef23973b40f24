#pragma once

#include <array>
#include <initializer_list>
#include <vector>

#include <opencv2/core.hpp>

#include "fathom/core/random.hpp"

namespace fathom {

/// Smooth random relief: random numbers on a square grid, joined by cubic B-splines. It has detail
/// at the scale of its cells, no preferred direction and no period.
class NoiseField {
 public:
  /// Covers pictures of `size`; `cell_px` > 0 is the grid's spacing.
  NoiseField(cv::Size size, double cell_px, RandomStream& stream);

  /// Adds gain × the field along one row of the picture; its standard deviation is about 1.
  void add_row(int row, float gain, float* out) const;

 private:
  /// Where a pixel lies on the grid along one axis, and the weights of the four points around it.
  struct Place {
    int first;
    std::array<float, 4> weights;
  };
  Place place(int pixel) const;

  /// Columns of one cell, from the end of the one before.
  struct Cell {
    int first;  ///< as of Place
    int end;
  };

  void add_cell(const float* points, int begin, int end, float* __restrict out) const;

  double cell_px_;
  cv::Mat_<float> grid_;
  // The same in all rows.
  std::vector<Cell> cells_;
  std::array<std::vector<float>, 4> weights_;  ///< by point, of every column
};

struct Octave {
  double cell_m;
  float gain;
};

/// A sum of fields, coarse to fine.
class Relief {
 public:
  /// Octaves finer than a pixel are left out.
  Relief(cv::Size size, double metres_per_pixel, std::initializer_list<Octave> octaves,
         RandomStream& stream);

  /// Overwrites `out` with a row of the picture.
  void row(int row, std::vector<float>& out) const;

 private:
  std::vector<NoiseField> fields_;
  std::vector<float> gains_;
};

}  // namespace fathom
