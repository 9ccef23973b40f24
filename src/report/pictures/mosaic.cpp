#include "fathom/report/mosaic.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "fathom/core/input_error.hpp"
#include "flat_field.hpp"
#include "floor_map.hpp"

namespace fathom {
namespace {

/// Pictures that the illumination is learnt from.
constexpr std::size_t kMostSamples = 40;

float bilinear(const cv::Mat& picture, double u, double v) {
  u = std::clamp(u, 0.0, picture.cols - 1.0);
  v = std::clamp(v, 0.0, picture.rows - 1.0);
  const int column = std::max(0, std::min(static_cast<int>(u), picture.cols - 2));
  const int row = std::max(0, std::min(static_cast<int>(v), picture.rows - 2));
  const int right = std::min(column + 1, picture.cols - 1);
  const auto fu = static_cast<float>(u - column);
  const auto fv = static_cast<float>(v - row);
  const float* top = picture.ptr<float>(row);
  const float* bottom = picture.ptr<float>(std::min(row + 1, picture.rows - 1));
  const float above = top[column] + fu * (top[right] - top[column]);
  const float below = bottom[column] + fu * (bottom[right] - bottom[column]);
  return above + fv * (below - above);
}

// 1 in the middle of the picture, 0 at its border.
float tent(double pixel, int count) {
  return static_cast<float>(1.0 - std::abs(2.0 * (pixel + 0.5) / count - 1.0));
}

/// One mosaic as it accumulates: weighted sums of grey levels.
class Blend {
 public:
  Blend(const Camera& camera, const MosaicPlan& plan)
      : camera_(camera),
        map_{plan.top_left_m, plan.metres_per_pixel, plan.size},
        sum_(cv::Mat::zeros(plan.size, CV_32F)),
        weight_(cv::Mat::zeros(plan.size, CV_32F)) {}

  /// CV_32F.
  void lay(const cv::Mat& picture, const PlacedPicture& place);
  /// Once; the sums are gone then.
  cv::Mat finish();

 private:
  cv::Rect box_of(const std::vector<Eigen::Vector2d>& outline) const;
  cv::Mat reduced(const cv::Mat& picture, double altitude_m) const;
  /// `row` of the box. The source may be reduced; `full` is the picture's own size.
  void lay_row(const cv::Mat& source, const PlacedPicture& place, const cv::Mat& mask,
               const cv::Rect& box, int row, cv::Size full);

  Camera camera_;
  FloorMap map_;
  cv::Mat sum_;
  cv::Mat weight_;
};

cv::Rect Blend::box_of(const std::vector<Eigen::Vector2d>& outline) const {
  Eigen::Vector2d low = map_.pixel(outline.front());
  Eigen::Vector2d high = low;
  for (const Eigen::Vector2d& point : outline) {
    low = low.cwiseMin(map_.pixel(point));
    high = high.cwiseMax(map_.pixel(point));
  }
  const cv::Point first(static_cast<int>(std::floor(low.x())),
                        static_cast<int>(std::floor(low.y())));
  const cv::Point last(static_cast<int>(std::ceil(high.x())),
                       static_cast<int>(std::ceil(high.y())));
  return cv::Rect(first, last + cv::Point(1, 1)) & cv::Rect({0, 0}, map_.size);
}

// Where the mosaic is coarser than the picture, its pixels are means and not samples.
cv::Mat Blend::reduced(const cv::Mat& picture, double altitude_m) const {
  const auto corners = camera_.footprint(altitude_m);
  const double width_px = (corners[1] - corners[0]).norm() / map_.metres_per_pixel;
  const double factor = std::floor(picture.cols / width_px);
  if (!(factor >= 2.0)) return picture;
  cv::Mat small;
  const cv::Size size(std::max(1, static_cast<int>(std::lround(picture.cols / factor))),
                      std::max(1, static_cast<int>(std::lround(picture.rows / factor))));
  cv::resize(picture, small, size, 0, 0, cv::INTER_AREA);
  return small;
}

void Blend::lay(const cv::Mat& picture, const PlacedPicture& place) {
  std::vector<Eigen::Vector2d> outline = seen_outline(camera_, place.altitude_m);
  for (Eigen::Vector2d& point : outline) point = transform(place.pose, point);
  const cv::Rect box = box_of(outline);
  if (box.empty()) return;
  const cv::Mat mask = mask_of(map_, outline, box);
  const cv::Mat source = reduced(picture, place.altitude_m);
  // Rows share nothing, so that the number of threads changes no sum.
  cv::parallel_for_({0, box.height}, [&](const cv::Range& rows) {
    for (int row = rows.start; row < rows.end; ++row) {
      lay_row(source, place, mask, box, row, picture.size());
    }
  });
}

void Blend::lay_row(const cv::Mat& source, const PlacedPicture& place, const cv::Mat& mask,
                    const cv::Rect& box, int row, cv::Size full) {
  const unsigned char* is_seen = mask.ptr(row);
  float* sum = sum_.ptr<float>(box.y + row) + box.x;
  float* weight = weight_.ptr<float>(box.y + row) + box.x;
  const double scale_u = source.cols / static_cast<double>(full.width);
  const double scale_v = source.rows / static_cast<double>(full.height);
  // Along a row the point in the body moves by equal steps.
  const Pose body_from_world = inverse(place.pose);
  const Eigen::Vector2d first = transform(body_from_world, map_.point(box.x, box.y + row));
  const Eigen::Vector2d step =
      transform(body_from_world, map_.point(box.x + 1, box.y + row)) - first;
  for (int column = 0; column < box.width; ++column) {
    if (is_seen[column] == 0) continue;
    const Eigen::Vector2d pixel = camera_.pixel(first + column * step, place.altitude_m);
    // Never quite zero, so that a picture's border shows where it is alone.
    const float share = std::max(1e-3F, tent(pixel.x(), full.width)) *
                        std::max(1e-3F, tent(pixel.y(), full.height));
    sum[column] += share * bilinear(source, scale_u * (pixel.x() + 0.5) - 0.5,
                                    scale_v * (pixel.y() + 0.5) - 0.5);
    weight[column] += share;
  }
}

cv::Mat Blend::finish() {
  cv::Mat mosaic(map_.size, CV_8U, cv::Scalar(kUnseen));
  for (int row = 0; row < mosaic.rows; ++row) {
    const float* sum = sum_.ptr<float>(row);
    const float* weight = weight_.ptr<float>(row);
    unsigned char* grey = mosaic.ptr(row);
    for (int column = 0; column < mosaic.cols; ++column) {
      if (!(weight[column] > 0.0F)) continue;
      const float mean = std::round(sum[column] / weight[column]);
      grey[column] = static_cast<unsigned char>(std::clamp(mean, 0.0F, kUnseen - 1.0F));
    }
  }
  sum_.release();
  weight_.release();
  return mosaic;
}

// Pictures whose middles lie further apart than the shorter side of a footprint show another piece
// of floor each.
double independent_count(const Camera& camera, const std::vector<PlacedPicture>& pictures) {
  const CameraModel& model = camera.model();
  const Eigen::Vector2d middle_px(0.5 * (model.width - 1), 0.5 * (model.height - 1));
  std::vector<Eigen::Vector2d> apart;
  for (const PlacedPicture& picture : pictures) {
    const auto corners = camera.footprint(picture.altitude_m);
    const double side_m =
        std::min((corners[1] - corners[0]).norm(), (corners[2] - corners[1]).norm());
    const Eigen::Vector2d middle =
        transform(picture.pose, camera.floor_point(middle_px, picture.altitude_m));
    const bool is_new = std::ranges::all_of(
        apart, [&](const Eigen::Vector2d& other) { return (middle - other).norm() >= side_m; });
    if (is_new) apart.push_back(middle);
  }
  return static_cast<double>(apart.size());
}

cv::Mat learnt_gain(const FrameSource& source, const std::vector<PlacedPicture>& pictures) {
  std::vector<PlacedPicture> samples;
  const std::size_t count = std::min(pictures.size(), kMostSamples);
  for (std::size_t i = 0; i < count; ++i) {
    samples.push_back(pictures[i * pictures.size() / count]);
  }
  const CameraModel& model = source.camera().model();
  FlatField field(cv::Size(model.width, model.height));
  for (const PlacedPicture& sample : samples) field.add(source.image(sample.frame));
  return field.gain(independent_count(source.camera(), samples));
}

struct Use {
  std::size_t mosaic = 0;
  const PlacedPicture* place = nullptr;
};

}  // namespace

std::vector<cv::Mat> make_mosaics(const FrameSource& source, std::span<const MosaicPlan> plans,
                                  const MosaicProgress& progress) {
  std::map<std::size_t, std::vector<Use>> uses;  // by frame
  std::vector<Blend> blends;
  const MosaicPlan* largest = nullptr;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    for (const PlacedPicture& place : plans[i].pictures) uses[place.frame].push_back({i, &place});
    blends.emplace_back(source.camera(), plans[i]);
    if (largest == nullptr || plans[i].pictures.size() > largest->pictures.size()) {
      largest = &plans[i];
    }
  }
  if (largest == nullptr) return {};
  const cv::Mat gain = learnt_gain(source, largest->pictures);
  std::size_t done = 0;
  for (const auto& [frame, mosaics] : uses) {
    cv::Mat picture;
    source.image(frame).convertTo(picture, CV_32F);
    cv::multiply(picture, gain, picture);
    for (const Use& use : mosaics) blends[use.mosaic].lay(picture, *use.place);
    if (progress) progress(++done, uses.size());
  }
  std::vector<cv::Mat> mosaics;
  mosaics.reserve(blends.size());
  for (Blend& blend : blends) mosaics.push_back(blend.finish());
  return mosaics;
}

}  // namespace fathom
