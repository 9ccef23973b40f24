#include "exposure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "blend.hpp"

namespace fathom {
namespace {

/// Cells over the shorter side of a footprint in the median.
constexpr double kCells = 24.0;

/// What keeps a factor at 1, as a share of the weight of the cells that a picture has in common
/// with others: it holds back the drift that small errors add up to along a chain of pictures.
constexpr double kPrior = 0.01;

/// No picture becomes more than this much brighter or darker.
constexpr double kMostGain = 2.0;

/// Alternations between the grey of the floor and the factors. Neighbours agree after a few.
constexpr int kAlternations = 50;

/// The log grey of a cell of the floor as one picture shows it.
struct Seen {
  std::uint32_t cell = 0;
  float log_grey = 0.0F;
};

/// A picture on a coarse floor, of which it covers a box.
struct CoarsePicture {
  cv::Point corner;
  cv::Mat grey;
};

CoarsePicture coarse_picture(const Camera& camera, const MosaicPlan& plan, const cv::Mat& picture,
                             const PlacedPicture& place) {
  const cv::Rect box = Blend::box_of(camera, plan, place);
  if (box.empty()) return {};
  Blend alone(camera, plan, box);
  alone.lay(picture, place);
  return {box.tl(), alone.finish()};
}

/// The pictures on a coarse floor.
class CoarseFloor {
 public:
  void add(std::size_t frame, const CoarsePicture& picture) {
    std::vector<Seen>& seen = seen_[frame];
    for (int v = 0; v < picture.grey.rows; ++v) {
      for (int u = 0; u < picture.grey.cols; ++u) {
        const unsigned char one = picture.grey.ptr(v)[u];
        if (one == kUnseen) continue;
        const std::uint32_t cell = cell_at(picture.corner.y + v, picture.corner.x + u);
        ++count_[cell];
        seen.push_back({cell, std::log(std::max(1.0F, static_cast<float>(one)))});
      }
    }
  }

  /// Alternating least squares: a cell's grey is the mean of what pictures with their factors show
  /// there, a picture's factor the one that fits the cells best.
  ExposureGains gains() const {
    std::map<std::size_t, double> log_gain;
    std::vector<double> floor(count_.size());
    for (int k = 0; k < kAlternations; ++k) {
      std::ranges::fill(floor, 0.0);
      for (const auto& [frame, seen] : seen_) {
        const double gain = log_gain[frame];
        for (const Seen& one : seen) floor[one.cell] += (one.log_grey + gain) / count_[one.cell];
      }
      for (const auto& [frame, seen] : seen_) log_gain[frame] = fitting(seen, floor);
    }
    const double most = std::log(kMostGain);
    ExposureGains gains;
    for (const auto& [frame, gain] : log_gain) {
      gains[frame] = static_cast<float>(std::exp(std::clamp(gain, -most, most)));
    }
    return gains;
  }

 private:
  std::uint32_t cell_at(int row, int column) {
    const std::uint64_t place =
        (static_cast<std::uint64_t>(row) << 32U) ^ static_cast<std::uint64_t>(column);
    const auto next = static_cast<std::uint32_t>(count_.size());
    const auto [cell, is_new] = cells_.emplace(place, next);
    if (is_new) count_.push_back(0);
    return cell->second;
  }

  double fitting(const std::vector<Seen>& seen, const std::vector<double>& floor) const {
    double sum = 0.0;
    double common = 0.0;
    for (const Seen& one : seen) {
      if (count_[one.cell] < 2) continue;
      sum += floor[one.cell] - one.log_grey;
      common += 1.0;
    }
    return common > 0.0 ? sum / ((1.0 + kPrior) * common) : 0.0;
  }

  std::unordered_map<std::uint64_t, std::uint32_t> cells_;
  std::vector<std::uint32_t> count_;  ///< pictures that show a cell
  std::map<std::size_t, std::vector<Seen>> seen_;
};

MosaicPlan coarse_of(const Camera& camera, const MosaicPlan& plan) {
  std::vector<double> sides_m;
  for (const PlacedPicture& place : plan.pictures) {
    const auto corners = camera.footprint(place.stance);
    sides_m.push_back(std::min((corners[1] - corners[0]).norm(), (corners[2] - corners[1]).norm()));
  }
  const auto middle = sides_m.begin() + static_cast<std::ptrdiff_t>(sides_m.size() / 2);
  std::ranges::nth_element(sides_m, middle);
  MosaicPlan coarse;
  coarse.top_left_m = plan.top_left_m;
  coarse.metres_per_pixel = *middle / kCells;
  const double ratio = plan.metres_per_pixel / coarse.metres_per_pixel;
  coarse.size = {static_cast<int>(std::ceil(plan.size.width * ratio)),
                 static_cast<int>(std::ceil(plan.size.height * ratio))};
  return coarse;
}

}  // namespace

std::vector<std::size_t> frames_of(const MosaicUses& uses) {
  std::vector<std::size_t> frames;
  frames.reserve(uses.size());
  for (const auto& [frame, places] : uses) frames.push_back(frame);
  return frames;
}

std::vector<ExposureGains> exposure_gains(const Camera& camera, const MosaicUses& uses,
                                          std::span<const MosaicPlan> plans,
                                          LitPictures& pictures) {
  std::vector<MosaicPlan> coarse;
  coarse.reserve(plans.size());
  for (const MosaicPlan& plan : plans) coarse.push_back(coarse_of(camera, plan));
  std::vector<CoarseFloor> floors(plans.size());
  // By frame and use; those of a frame are gone when they have been added.
  std::map<std::size_t, std::vector<CoarsePicture>> laid;
  for (const auto& [frame, places] : uses) laid[frame].resize(places.size());
  const auto lay = [&](std::size_t frame, const cv::Mat& picture) {
    const std::vector<MosaicUse>& places = uses.at(frame);
    for (std::size_t i = 0; i < places.size(); ++i) {
      laid.at(frame)[i] =
          coarse_picture(camera, coarse[places[i].mosaic], picture, *places[i].place);
    }
  };
  const auto add = [&](std::size_t frame, const cv::Mat& /*picture*/) {
    const std::vector<MosaicUse>& places = uses.at(frame);
    for (std::size_t i = 0; i < places.size(); ++i) {
      floors[places[i].mosaic].add(frame, laid.at(frame)[i]);
    }
    laid.at(frame).clear();
  };
  pictures.for_each(frames_of(uses), add, lay);
  std::vector<ExposureGains> gains;
  gains.reserve(floors.size());
  for (const CoarseFloor& floor : floors) gains.push_back(floor.gains());
  return gains;
}

}  // namespace fathom
