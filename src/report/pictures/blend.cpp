#include "blend.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "laid_picture.hpp"

namespace fathom {
namespace {

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

LaidPicture laid_picture(const Camera& camera, const cv::Mat& source, const cv::Mat& broad,
                         cv::Size full, const PlacedPicture& place, const FloorMap& map,
                         cv::Point first, float gain) {
  const Pose body_from_world = inverse(place.pose);
  const auto at = [&](int column, int row) {
    return transform(body_from_world, map.point(first.x + column, first.y + row));
  };
  const Eigen::Vector2d corner = at(0, 0);
  return {camera,
          source,
          broad,
          1.0 / full.width,
          1.0 / full.height,
          place.stance,
          corner,
          at(1, 0) - corner,
          at(0, 1) - corner,
          gain};
}

/// Cells of the broad band over the shorter side of a picture: enough for light, and too few for
/// most of what lies on the floor, which would be seen twice where it is misplaced.
constexpr double kBroadCells = 6.0;

/// The means of square cells.
cv::Mat broad_band(const cv::Mat& source) {
  const double side = std::min(source.cols, source.rows) / kBroadCells;
  if (side <= 1.0) return source;
  const auto cells = [side](int pixels) { return static_cast<int>(std::lround(pixels / side)); };
  cv::Mat broad;
  cv::resize(source, broad, {cells(source.cols), cells(source.rows)}, 0, 0, cv::INTER_AREA);
  return broad;
}

/// Columns, and rows, between two that are projected. Lenses and tilts bend so little over them
/// that lines stand for the projection: less than 0.02 pixels off at 0.2 rad of tilt and 500 pixels
/// of focal length.
constexpr int kSpan = 8;

/// kSpan rows of a box, whose projections are lines between those of every kSpan-th pixel.
class Strip {
 public:
  /// `mask`: of the box, what the picture covers.
  Strip(const LaidPicture& laid, const cv::Mat& mask, int first_row)
      : laid_(laid),
        mask_(mask),
        first_row_(first_row),
        nodes_(static_cast<std::size_t>(mask.cols / kSpan + 1)) {}

  /// The picture's pixel at the box's; `column` is a multiple of kSpan.
  Eigen::Vector2d pixel_at(int row, int column) {
    const int last_row = first_row_ + kSpan;
    if (last_row >= mask_.rows || !is_seen(first_row_, column) || !is_seen(last_row, column)) {
      return laid_.pixel_at(row, column);
    }
    Node& node = nodes_[static_cast<std::size_t>(column / kSpan)];
    if (!node.is_known) {
      node = {laid_.pixel_at(first_row_, column), laid_.pixel_at(last_row, column), true};
    }
    return node.first + (row - first_row_) / static_cast<double>(kSpan) * (node.last - node.first);
  }

 private:
  struct Node {
    Eigen::Vector2d first;
    Eigen::Vector2d last;
    bool is_known = false;
  };

  bool is_seen(int row, int column) const { return mask_.at<unsigned char>(row, column) != 0; }

  const LaidPicture& laid_;
  const cv::Mat& mask_;
  int first_row_;
  std::vector<Node> nodes_;
};

/// Adds columns [begin, end) of a row, all within the span that begins with `span`; the sums count
/// from `begin`.
void add_span(const LaidPicture& laid, Strip& strip, const cv::Mat& mask, int row, int span,
              int begin, int end, const BandSums& sums) {
  const unsigned char* is_seen = mask.ptr(row);
  const bool is_whole =
      span + kSpan < mask.cols && std::all_of(is_seen + span, is_seen + span + kSpan + 1,
                                              [](unsigned char one) { return one != 0; });
  if (!is_whole) {
    for (int c = begin; c < end; ++c) {
      if (is_seen[c] == 0) continue;
      add_pixels<1>(laid, laid.pixel_at(row, c), Eigen::Vector2d::Zero(), 0, 1,
                    sums.from(c - begin));
    }
    return;
  }
  const Eigen::Vector2d first = strip.pixel_at(row, span);
  const Eigen::Vector2d last = strip.pixel_at(row, span + kSpan);
  add_pixels<kSpan>(laid, first, (last - first) / kSpan, begin - span, end - span, sums);
}

}  // namespace

Blend::Blend(const Camera& camera, const MosaicPlan& plan, const cv::Rect& window)
    : camera_(camera),
      map_{plan.top_left_m, plan.metres_per_pixel, plan.size},
      window_(window),
      fine_(window.size()) {
  if (plan.blend == MosaicBlend::seams) broad_.emplace(window.size());
}

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
  const cv::Mat broad = broad_ ? broad_band(source) : cv::Mat();
  const LaidPicture laid =
      laid_picture(camera_, source, broad, picture.size(), place, map_, box.tl(), gain);
  // Rows share nothing, so that the number of threads changes no sum. Rows and columns count from
  // the box's first, whatever the window.
  const cv::Rect lit = part - box.tl();
  cv::parallel_for_({lit.y / kSpan, (lit.y + lit.height - 1) / kSpan + 1}, [&](const cv::Range& r) {
    for (int first_row = r.start * kSpan; first_row < r.end * kSpan; first_row += kSpan) {
      Strip strip(laid, mask, first_row);
      const int last = std::min(first_row + kSpan, lit.y + lit.height);
      for (int row = std::max(first_row, lit.y); row < last; ++row) {
        const cv::Point at = cv::Point(lit.x, row) + box.tl() - window_.tl();
        const BandSums sums{fine_.from(at), broad_ ? broad_->from(at) : WeightedSums{}};
        const int end = lit.x + lit.width;
        for (int begin = lit.x; begin < end;) {
          const int span = begin - begin % kSpan;
          const int next = std::min(span + kSpan, end);
          add_span(laid, strip, mask, row, span, begin, next, sums.from(begin - lit.x));
          begin = next;
        }
      }
    }
  });
}

cv::Mat Blend::finish() {
  cv::Mat mosaic(window_.size(), CV_8U);
  cv::parallel_for_({0, mosaic.rows}, [&](const cv::Range& rows) {
    for (int row = rows.start; row < rows.end; ++row) {
      const WeightedSums fine = fine_.from({0, row});
      const WeightedSums broad = broad_ ? broad_->from({0, row}) : WeightedSums{};
      unsigned char* grey = mosaic.ptr(row);
      for (int column = 0; column < mosaic.cols; ++column) {
        grey[column] = kUnseen;
        if (!(fine.weight[column] > 0.0F)) continue;
        float mean = fine.sum[column] / fine.weight[column];
        if (broad_) mean += broad.sum[column] / broad.weight[column];
        grey[column] =
            static_cast<unsigned char>(std::lround(std::clamp(mean, 0.0F, kUnseen - 1.0F)));
      }
    }
  });
  fine_.release();
  broad_.reset();
  return mosaic;
}

}  // namespace fathom
