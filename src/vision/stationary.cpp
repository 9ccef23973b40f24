#include "stationary.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace fathom {
namespace {

struct Box {
  Eigen::Vector2d low;
  Eigen::Vector2d high;
};

Box box_of(const std::vector<Eigen::Vector2d>& pixels) {
  Box box{pixels.front(), pixels.front()};
  for (const Eigen::Vector2d& pixel : pixels) {
    box.low = box.low.cwiseMin(pixel);
    box.high = box.high.cwiseMax(pixel);
  }
  return box;
}

std::size_t cell_of(const Eigen::Vector2d& pixel, const Box& box, int cells) {
  const auto index = [cells](double x, double low, double high) {
    const double share = high > low ? (x - low) / (high - low) : 0.0;
    return static_cast<std::size_t>(std::clamp(static_cast<int>(cells * share), 0, cells - 1));
  };
  return index(pixel.y(), box.low.y(), box.high.y()) * static_cast<std::size_t>(cells) +
         index(pixel.x(), box.low.x(), box.high.x());
}

bool stays(const Features& from, const Features& to, const Match& match,
           const StationaryRule& rule) {
  return (from.pixels[static_cast<std::size_t>(match.from)] -
          to.pixels[static_cast<std::size_t>(match.to)])
             .norm() <= rule.most_motion_px;
}

bool stay(const Features& from, const Features& to, const std::vector<Match>& inliers,
          const StationaryRule& rule) {
  const auto count = std::ranges::count_if(
      inliers, [&](const Match& match) { return stays(from, to, match, rule); });
  return static_cast<double>(count) >= rule.share_of_matches * static_cast<double>(inliers.size());
}

}  // namespace

std::vector<int> staying(const Features& from, const Features& to,
                         const std::vector<Match>& matches, const StationaryRule& rule) {
  std::vector<int> indices;
  if (from.pixels.empty() || to.pixels.empty()) return indices;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (stays(from, to, matches[i], rule)) indices.push_back(static_cast<int>(i));
  }
  return indices;
}

std::string reason_of_what_stays(const Features& from, const Features& to,
                                 const std::vector<Match>& inliers,
                                 const std::vector<Match>& matches, const StationaryRule& rule) {
  // Points that come without pixels are no pictures.
  if (inliers.empty() || from.pixels.empty() || to.pixels.empty()) return {};
  if (!stay(from, to, inliers, rule)) return {};
  const Box box = box_of(from.pixels);
  const auto side = static_cast<std::size_t>(rule.cells);
  std::vector<int> features(side * side);
  std::vector<int> matched(side * side);
  for (const Eigen::Vector2d& pixel : from.pixels) ++features[cell_of(pixel, box, rule.cells)];
  const auto count = [&](const Match& match) {
    ++matched[cell_of(from.pixels[static_cast<std::size_t>(match.from)], box, rule.cells)];
  };
  std::ranges::for_each(inliers, count);
  for (const Match& match : matches) {
    if (stays(from, to, match, rule)) count(match);
  }
  int cells = 0;
  int agreeing = 0;
  for (std::size_t cell = 0; cell < features.size(); ++cell) {
    if (features[cell] < rule.least_features) continue;
    ++cells;
    agreeing += matched[cell] > 0 ? 1 : 0;
  }
  if (agreeing >= rule.least_cells * cells) return {};
  return fmt::format(
      "{} matches agree that nothing moves, in {} of {} parts of the picture: something in view "
      "that moves with the camera, half are needed of a vehicle at rest",
      inliers.size(), agreeing, cells);
}

}  // namespace fathom
