#include "fathom/report/footprints.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/geometry/keyframe_grid.hpp"

namespace fathom {
namespace {

/// Of those that may overlap a keyframe, how many are looked at: as many as pass over one place.
constexpr std::size_t kMostOthers = 16;

/// A footprint about its middle.
struct Extent {
  Eigen::Vector2d middle;
  double outer_m = 0.0;  ///< of the circle about it
  double inner_m = 0.0;  ///< of the circle within it
};

using Corners = std::array<Eigen::Vector2d, 4>;

Corners corners_of(const Camera& camera, const KeyframePicture& keyframe, std::size_t index) {
  Corners corners = camera.footprint(keyframe.stance);
  for (Eigen::Vector2d& corner : corners) {
    corner = transform(keyframe.pose, corner);
    if (corner.allFinite()) continue;
    throw InputError("the pose of keyframe " + std::to_string(index) + " is not finite");
  }
  return corners;
}

Extent extent_of(const Corners& corners) {
  Extent extent{Eigen::Vector2d::Zero(), 0.0, std::numeric_limits<double>::infinity()};
  for (const Eigen::Vector2d& corner : corners) extent.middle += 0.25 * corner;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d side = corners[(i + 1) % corners.size()] - corners[i];
    const Eigen::Vector2d to_middle = extent.middle - corners[i];
    const double off = std::abs(side.x() * to_middle.y() - side.y() * to_middle.x()) / side.norm();
    extent.outer_m = std::max(extent.outer_m, to_middle.norm());
    extent.inner_m = std::min(extent.inner_m, off);
  }
  return extent;
}

// Metres, to 1e-6: what lies below depends on the last bit of a pose.
std::string micrometres(double value_m) {
  return number_text(std::round(1e6 * value_m) / 1e6 + 0.0);
}

/// Finds the overlaps of all keyframes.
class Overlaps {
 public:
  Overlaps(const Camera& camera, std::span<const KeyframePicture> keyframes,
           const std::vector<Footprint>& footprints)
      : camera_(camera), keyframes_(keyframes), grid_(index_of(footprints)) {}

  double between(std::size_t i, std::size_t k) const {
    const Pose motion = compose(inverse(keyframes_[i].pose), keyframes_[k].pose);
    return footprint_overlap(camera_, keyframes_[i].stance, keyframes_[k].stance, motion);
  }

  void find_other_pass(std::size_t i, Footprint& footprint) const {
    for (const std::size_t k : nearest_of_other_passes(i)) {
      const double overlap = between(i, k);
      if (!(overlap > footprint.overlap_other_pass)) continue;
      footprint.overlap_other_pass = overlap;
      footprint.other_pass = k;
    }
  }

 private:
  KeyframeGrid index_of(const std::vector<Footprint>& footprints) {
    for (const Footprint& footprint : footprints) {
      extents_.push_back(extent_of(footprint.corners));
      middles_.append({extents_.back().middle.x(), extents_.back().middle.y(), 0.0});
      largest_m_ = std::max(largest_m_, extents_.back().outer_m);
    }
    KeyframeGrid grid(2.0 * largest_m_);
    grid.follow(middles_);
    return grid;
  }

  double distance_m(std::size_t i, std::size_t k) const {
    return (extents_[i].middle - extents_[k].middle).norm();
  }

  bool overlap_at_all(std::size_t i, std::size_t k) const {
    const double apart_m = distance_m(i, k);
    const bool is_inner = apart_m < extents_[i].inner_m + extents_[k].inner_m;
    if (is_inner && camera_.model().has_straight_sides()) return true;
    if (apart_m > extents_[i].outer_m + extents_[k].outer_m) return false;
    return between(i, k) > 0.0;
  }

  // The keyframes about i, all of which overlap it: first, and one past the last.
  std::pair<std::size_t, std::size_t> pass_of(std::size_t i) const {
    std::size_t first = i;
    while (first > 0 && overlap_at_all(i, first - 1)) --first;
    std::size_t end = i + 1;
    while (end < keyframes_.size() && overlap_at_all(i, end)) ++end;
    return {first, end};
  }

  std::vector<std::size_t> nearest_of_other_passes(std::size_t i) const {
    const auto [first, end] = pass_of(i);
    std::vector<std::pair<double, std::size_t>> near;
    for (const std::size_t k : grid_.near(extents_[i].middle, extents_[i].outer_m + largest_m_)) {
      if (k >= first && k < end) continue;
      const double apart_m = distance_m(i, k);
      if (apart_m < extents_[i].outer_m + extents_[k].outer_m) near.emplace_back(apart_m, k);
    }
    const std::size_t count = std::min(near.size(), kMostOthers);
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
    std::vector<std::size_t> nearest;
    for (std::size_t n = 0; n < count; ++n) nearest.push_back(near[n].second);
    return nearest;
  }

  const Camera& camera_;
  std::span<const KeyframePicture> keyframes_;
  std::vector<Extent> extents_;
  GivenTrajectory middles_;
  double largest_m_ = 0.0;
  KeyframeGrid grid_;
};

}  // namespace

std::vector<Footprint> footprints(const Camera& camera,
                                  std::span<const KeyframePicture> keyframes) {
  std::vector<Footprint> all;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    all.push_back({i, keyframes[i].time_ns, corners_of(camera, keyframes[i], i), {}, 0.0, {}});
  }
  if (all.empty()) return all;
  const Overlaps overlaps(camera, keyframes, all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0) all[i].overlap_previous = overlaps.between(i - 1, i);
    overlaps.find_other_pass(i, all[i]);
  }
  return all;
}

std::string footprints_csv(std::span<const Footprint> footprints) {
  std::string text = "keyframe,time_ns";
  for (const std::string corner : {"top_left", "top_right", "bottom_right", "bottom_left"}) {
    text += ",x_" + corner + "_m,y_" + corner + "_m";
  }
  text += ",overlap_previous,overlap_other_pass,other_pass\n";
  const auto share = [](double value) { return short_number(value, 6); };
  for (const Footprint& one : footprints) {
    text += std::to_string(one.keyframe) + "," + std::to_string(one.time_ns);
    for (const Eigen::Vector2d& corner : one.corners) {
      text += "," + micrometres(corner.x()) + "," + micrometres(corner.y());
    }
    text += "," + (one.overlap_previous ? share(*one.overlap_previous) : "");
    text += "," + share(one.overlap_other_pass) + ",";
    text += (one.other_pass ? std::to_string(*one.other_pass) : "") + "\n";
  }
  return text;
}

}  // namespace fathom
