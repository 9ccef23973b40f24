#include "blend.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "sample.hpp"

namespace fathom {
namespace {

// 1 in the middle of the picture, 0 at its border, which `place` runs over from 0 to 1.
float tent(double place) {
  return static_cast<float>(1.0 - std::abs(2.0 * place - 1.0));
}

std::vector<Eigen::Vector2d> outline_of(const Camera& camera, const PlacedPicture& place) {
  std::vector<Eigen::Vector2d> outline = seen_outline(camera, place.stance);
  for (Eigen::Vector2d& point : outline) point = transform(place.pose, point);
  return outline;
}

cv::Rect box_around(const FloorMap& map, const std::vector<Eigen::Vector2d>& outline) {
  Eigen::Vector2d low = map.pixel(outline.front());
  Eigen::Vector2d high = low;
  for (const Eigen::Vector2d& point : outline) {
    low = low.cwiseMin(map.pixel(point));
    high = high.cwiseMax(map.pixel(point));
  }
  const cv::Point first(static_cast<int>(std::floor(low.x())),
                        static_cast<int>(std::floor(low.y())));
  const cv::Point last(static_cast<int>(std::ceil(high.x())),
                       static_cast<int>(std::ceil(high.y())));
  return cv::Rect(first, last + cv::Point(1, 1)) & cv::Rect({0, 0}, map.size);
}

/// A row of a picture's box as the picture is laid on it.
struct RowOfBox {
  const Camera& camera;
  const cv::Mat& source;  ///< the picture, perhaps reduced
  double per_width;       ///< 1 over the picture's own size
  double per_height;
  Stance stance;
  Eigen::Vector2d first;  ///< of the box's first column, in the body frame
  Eigen::Vector2d step;   ///< from column to column
  float gain;
  bool has_seams;
};

RowOfBox row_of_box(const Camera& camera, const cv::Mat& source, cv::Size full,
                    const PlacedPicture& place, const FloorMap& map, cv::Point first, float gain,
                    bool has_seams) {
  const Pose body_from_world = inverse(place.pose);
  const Eigen::Vector2d begin = transform(body_from_world, map.point(first.x, first.y));
  const Eigen::Vector2d next = transform(body_from_world, map.point(first.x + 1, first.y));
  return {camera,       source, 1.0 / full.width, 1.0 / full.height, place.stance, begin,
          next - begin, gain,   has_seams};
}

Eigen::Vector2d pixel_at(const RowOfBox& row, int column) {
  return row.camera.pixel(row.first + column * row.step, row.stance);
}

// Of the weights of two pictures the larger one counts alone, but where they differ by less than a
// seventh: the seam. The least is one that a float still holds.
float seam_weight(float share) {
  share = std::max(1e-2F, share);
  share *= share;  // ²
  share *= share;  // ⁴
  share *= share;  // ⁸
  return share * share;
}

/// Columns between two that are projected. Lenses and tilts bend so little over them that a line
/// stands for the projection: less than 0.01 pixels off at 0.2 rad of tilt and 500 pixels of focal
/// length.
constexpr int kSpan = 8;

/// The weights of columns of a span, whose pixels of the picture begin with `first`. All of them,
/// so that the compiler knows how many.
template <int kCount>
std::array<float, kCount> shares_of(const RowOfBox& row, const Eigen::Vector2d& first,
                                    const Eigen::Vector2d& step) {
  std::array<float, kCount> shares;
  for (int i = 0; i < kCount; ++i) {
    const double u = (first.x() + i * step.x() + 0.5) * row.per_width;
    const double v = (first.y() + i * step.y() + 0.5) * row.per_height;
    // Never quite zero, so that a picture's border shows where it is alone.
    shares[i] = std::max(1e-3F, tent(u)) * std::max(1e-3F, tent(v));
  }
  if (row.has_seams) {
    for (int i = 0; i < kCount; ++i) shares[i] = seam_weight(shares[i]);
  }
  return shares;
}

/// Adds columns [begin, end) of kCount; `sum` and `weight` count from `begin`.
template <int kCount>
void add_pixels(const RowOfBox& row, const Eigen::Vector2d& first, const Eigen::Vector2d& step,
                int begin, int end, float* sum, float* weight) {
  const std::array<float, kCount> shares = shares_of<kCount>(row, first, step);
  const double columns_per_pixel = row.per_width * row.source.cols;
  const double rows_per_pixel = row.per_height * row.source.rows;
  const auto u_of = [&](int i) {
    return (first.x() + i * step.x() + 0.5) * columns_per_pixel - 0.5;
  };
  const auto v_of = [&](int i) { return (first.y() + i * step.y() + 0.5) * rows_per_pixel - 0.5; };
  const auto is_within = [&](int i) {
    return u_of(i) >= 0.0 && u_of(i) < row.source.cols - 1.0 && v_of(i) >= 0.0 &&
           v_of(i) < row.source.rows - 1.0;
  };
  const bool are_within = is_within(begin) && is_within(end - 1);
  for (int i = begin; i < end; ++i, ++sum, ++weight) {
    const float share = shares[i];
    // Away from the seams it would not show.
    if (row.has_seams && share * 512.0F < *weight) continue;
    const float grey = are_within ? sample_within(row.source, u_of(i), v_of(i))
                                  : sample(row.source, u_of(i), v_of(i));
    *sum += share * row.gain * grey;
    *weight += share;
  }
}

/// The projections at both ends of a span. The end of one is the begin of the next.
class Spans {
 public:
  explicit Spans(const RowOfBox& row) : row_(row) {}

  /// Of the span that begins with column `span`.
  std::pair<Eigen::Vector2d, Eigen::Vector2d> ends(int span) {
    const Eigen::Vector2d first = span == at_ ? last_ : pixel_at(row_, span);
    at_ = span + kSpan;
    last_ = pixel_at(row_, at_);
    return {first, last_};
  }

 private:
  const RowOfBox& row_;
  int at_ = -1;
  Eigen::Vector2d last_ = Eigen::Vector2d::Zero();
};

/// Adds columns [begin, end) of a row, all within the span that begins with `span`; columns count
/// from the box's first, `sum` and `weight` from `begin`. `is_seen` is the mask of the box's row.
void add_span(const RowOfBox& row, Spans& spans, const unsigned char* is_seen, int width, int span,
              int begin, int end, float* sum, float* weight) {
  const bool is_whole =
      span + kSpan < width && std::all_of(is_seen + span, is_seen + span + kSpan + 1,
                                          [](unsigned char one) { return one != 0; });
  if (!is_whole) {
    for (int c = begin; c < end; ++c) {
      if (is_seen[c] == 0) continue;
      add_pixels<1>(row, pixel_at(row, c), Eigen::Vector2d::Zero(), 0, 1, sum + (c - begin),
                    weight + (c - begin));
    }
    return;
  }
  const auto [first, last] = spans.ends(span);
  add_pixels<kSpan>(row, first, (last - first) / kSpan, begin - span, end - span, sum, weight);
}

}  // namespace

Blend::Blend(const Camera& camera, const MosaicPlan& plan, const cv::Rect& window)
    : camera_(camera),
      map_{plan.top_left_m, plan.metres_per_pixel, plan.size},
      has_seams_(plan.blend == MosaicBlend::seams),
      window_(window),
      sum_(cv::Mat::zeros(window.size(), CV_32F)),
      weight_(cv::Mat::zeros(window.size(), CV_32F)) {}

cv::Rect Blend::box_of(const Camera& camera, const MosaicPlan& plan, const PlacedPicture& place) {
  return box_around({plan.top_left_m, plan.metres_per_pixel, plan.size}, outline_of(camera, place));
}

// Where the mosaic is coarser than the picture, its pixels are means and not samples.
cv::Mat Blend::reduced(const cv::Mat& picture, const Stance& stance) const {
  const auto corners = camera_.footprint(stance);
  const double width_px = (corners[1] - corners[0]).norm() / map_.metres_per_pixel;
  const double factor = std::floor(picture.cols / width_px);
  if (!(factor >= 2.0)) return picture;
  cv::Mat small;
  const cv::Size size(std::max(1, static_cast<int>(std::lround(picture.cols / factor))),
                      std::max(1, static_cast<int>(std::lround(picture.rows / factor))));
  cv::resize(picture, small, size, 0, 0, cv::INTER_AREA);
  return small;
}

void Blend::lay(const cv::Mat& picture, const PlacedPicture& place, float gain) {
  const std::vector<Eigen::Vector2d> outline = outline_of(camera_, place);
  const cv::Rect box = box_around(map_, outline);
  const cv::Rect part = box & window_;
  if (part.empty()) return;
  const cv::Mat mask = mask_of(map_, outline, box);
  const cv::Mat source = reduced(picture, place.stance);
  // Rows share nothing, so that the number of threads changes no sum.
  cv::parallel_for_({part.y, part.y + part.height}, [&](const cv::Range& rows) {
    for (int v = rows.start; v < rows.end; ++v) {
      const RowOfBox row = row_of_box(camera_, source, picture.size(), place, map_,
                                      cv::Point(box.x, v), gain, has_seams_);
      Spans spans(row);
      float* sum = sum_.ptr<float>(v - window_.y) + (part.x - window_.x);
      float* weight = weight_.ptr<float>(v - window_.y) + (part.x - window_.x);
      const int end = part.x + part.width - box.x;
      for (int begin = part.x - box.x; begin < end;) {
        const int span = begin - begin % kSpan;
        const int next = std::min(span + kSpan, end);
        add_span(row, spans, mask.ptr(v - box.y), box.width, span, begin, next, sum, weight);
        sum += next - begin;
        weight += next - begin;
        begin = next;
      }
    }
  });
}

cv::Mat Blend::finish() {
  cv::Mat mosaic(window_.size(), CV_8U, cv::Scalar(kUnseen));
  cv::parallel_for_({0, mosaic.rows}, [&](const cv::Range& rows) {
    for (int row = rows.start; row < rows.end; ++row) {
      const float* sum = sum_.ptr<float>(row);
      const float* weight = weight_.ptr<float>(row);
      unsigned char* grey = mosaic.ptr(row);
      for (int column = 0; column < mosaic.cols; ++column) {
        if (!(weight[column] > 0.0F)) continue;
        const float mean = std::clamp(sum[column] / weight[column], 0.0F, kUnseen - 1.0F);
        grey[column] = static_cast<unsigned char>(std::lround(mean));
      }
    }
  });
  sum_.release();
  weight_.release();
  return mosaic;
}

}  // namespace fathom
