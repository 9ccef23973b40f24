#include "floor_lookup.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "floor_renderer.hpp"

namespace fathom {
namespace {

int floor_of(float value) {
  const int towards_zero = static_cast<int>(value);
  return towards_zero - (value < static_cast<float>(towards_zero) ? 1 : 0);
}

// The coarsest level that has at least two pixels to one of the view.
std::size_t level_for(double floor_pixels_per_pixel, std::size_t levels) {
  const double level = std::floor(std::log2(floor_pixels_per_pixel)) - 1.0;
  return static_cast<std::size_t>(std::clamp(level, 0.0, static_cast<double>(levels - 1)));
}

constexpr int kAcross = FloorRenderer::kSamplesAcross;
constexpr float kStep = 1.0F / kAcross;

}  // namespace

std::vector<cv::Mat> area_pyramid(const cv::Mat& picture) {
  std::vector<cv::Mat> levels{picture};
  while (std::min(levels.back().rows, levels.back().cols) >= 4) {
    const cv::Mat& last = levels.back();
    const cv::Size half{last.cols / 2, last.rows / 2};
    // An odd last row or column is left out: any other ratio than two would shift the rest.
    cv::Mat next;
    cv::resize(last(cv::Rect(0, 0, 2 * half.width, 2 * half.height)), next, half, 0, 0,
               cv::INTER_AREA);
    levels.push_back(next);
  }
  return levels;
}

FloorLookup::FloorLookup(const std::vector<cv::Mat>& levels, const Eigen::Vector2d& base,
                         const Eigen::Matrix2d& A, double floor_pixels_per_pixel) {
  const std::size_t index = level_for(floor_pixels_per_pixel, levels.size());
  level_ = levels[index];
  const double scale = std::ldexp(1.0, -static_cast<int>(index));
  const Eigen::Vector2d level_base = scale * (base.array() + 0.5) - 0.5;
  const Eigen::Vector2d origin = level_base.array().floor();
  base_ = (level_base - origin).cast<float>();
  A_ = (scale * A).cast<float>();
  first_ = (-origin).cast<float>();
  last_ = (Eigen::Vector2d(level_.cols - 1, level_.rows - 1) - origin).cast<float>();
  row_bytes_ = static_cast<std::ptrdiff_t>(level_.step);
  offset_ = static_cast<std::ptrdiff_t>(origin.y()) * row_bytes_ +
            static_cast<std::ptrdiff_t>(origin.x());
}

/// Corners of pixels side by side; where there are fewer, the last pixel is repeated. Loops over
/// them have a length that the compiler knows, so that it uses vectors.
struct FloorLookup::Block {
  /// Along one axis.
  struct Corners {
    Values upper_left, upper_right, lower_left, lower_right;

    Corners(const std::vector<float>& upper, const std::vector<float>& lower, std::size_t first) {
      const std::size_t last = upper.size() - 2;
      for (std::size_t p = 0; p < kBlock; ++p) {
        const std::size_t left = std::min(first + p, last);
        upper_left[p] = upper[left];
        upper_right[p] = upper[left + 1];
        lower_left[p] = lower[left];
        lower_right[p] = lower[left + 1];
      }
    }
  };

  /// A row of samples in each pixel.
  struct Line {
    Values left, step;

    Line(const Corners& corners, float down) {
      for (std::size_t p = 0; p < kBlock; ++p) {
        left[p] = corners.upper_left[p] + down * (corners.lower_left[p] - corners.upper_left[p]);
        const float right =
            corners.upper_right[p] + down * (corners.lower_right[p] - corners.upper_right[p]);
        step[p] = kStep * (right - left[p]);
      }
    }

    Values at(float along) const {
      Values values;
      for (std::size_t p = 0; p < kBlock; ++p) values[p] = left[p] + along * step[p];
      return values;
    }
  };

  Corners x;
  Corners y;
};

void FloorLookup::means(const Places& upper, const Places& lower, float* out) const {
  const std::size_t pixels = upper.x.size() - 1;
  for (std::size_t first = 0; first < pixels; first += kBlock) {
    const std::size_t count = std::min(kBlock, pixels - first);
    const Block block{{upper.x, lower.x, first}, {upper.y, lower.y, first}};
    Values means;
    if (are_inside(upper, first, count + 1) && are_inside(lower, first, count + 1)) {
      mean_of_samples<false>(block, means);
    } else {
      mean_of_samples<true>(block, means);
    }
    std::copy_n(means.begin(), count, out + first);
  }
}

// A whole pixel of room: the last one has none to its right, and rounding may step over.
bool FloorLookup::are_inside(const Places& places, std::size_t first, std::size_t count) const {
  const Eigen::Vector2f low = first_.array() + 1.0F;
  const Eigen::Vector2f high = last_.array() - 1.0F;
  bool are_inside = true;
  for (std::size_t i = first; i < first + count; ++i) {
    const float x = places.x[i];
    const float y = places.y[i];
    are_inside &= x >= low.x() && x <= high.x() && y >= low.y() && y <= high.y();
  }
  return are_inside;
}

template <bool kNearBorder>
void FloorLookup::mean_of_samples(const Block& block, Values& means) const {
  means.fill(0.0F);
  for (int j = 0; j < kAcross; ++j) {
    const float down = kStep * (static_cast<float>(j) + 0.5F);
    const Block::Line x(block.x, down);
    const Block::Line y(block.y, down);
    for (int i = 0; i < kAcross; ++i) {
      const float along = static_cast<float>(i) + 0.5F;
      add_samples<kNearBorder>(x.at(along), y.at(along), means);
    }
  }
  for (float& mean : means) mean *= kStep * kStep;
}

// Bilinear.
template <bool kNearBorder>
void FloorLookup::add_samples(Values x, Values y, Values& sums) const {
  std::array<int, kBlock> columns;
  std::array<int, kBlock> rows;
  for (std::size_t p = 0; p < kBlock; ++p) {
    if (kNearBorder) {
      x[p] = std::min(std::max(x[p], first_.x()), last_.x());
      y[p] = std::min(std::max(y[p], first_.y()), last_.y());
    }
    columns[p] = floor_of(x[p]);
    rows[p] = floor_of(y[p]);
    x[p] -= static_cast<float>(columns[p]);
    y[p] -= static_cast<float>(rows[p]);
  }
  std::array<std::array<uchar, kBlock>, 4> grey;
  for (std::size_t p = 0; p < kBlock; ++p) {
    const uchar* pixel = level_.data + (offset_ + rows[p] * row_bytes_ + columns[p]);
    const bool is_last_column = kNearBorder && static_cast<float>(columns[p]) >= last_.x();
    const bool is_last_row = kNearBorder && static_cast<float>(rows[p]) >= last_.y();
    const std::ptrdiff_t right = is_last_column ? 0 : 1;
    const std::ptrdiff_t below = is_last_row ? 0 : row_bytes_;
    grey[0][p] = pixel[0];
    grey[1][p] = pixel[right];
    grey[2][p] = pixel[below];
    grey[3][p] = pixel[below + right];
  }
  for (std::size_t p = 0; p < kBlock; ++p) {
    const auto upper_left = static_cast<float>(grey[0][p]);
    const auto lower_left = static_cast<float>(grey[2][p]);
    const float upper = upper_left + x[p] * (static_cast<float>(grey[1][p]) - upper_left);
    const float lower = lower_left + x[p] * (static_cast<float>(grey[3][p]) - lower_left);
    sums[p] += upper + y[p] * (lower - upper);
  }
}

}  // namespace fathom
