#include "stationary.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace fathom {
namespace {

constexpr double kMostMotionPx = 1.0;
/// Of matches: the fit leaves out few that agree by chance.
constexpr double kShareThatStays = 0.95;
constexpr int kCells = 8;          ///< along each side of the picture
constexpr int kLeastFeatures = 3;  ///< of a cell that is to have a match
constexpr double kLeastCells = 0.5;

using Counts = std::array<int, static_cast<std::size_t>(kCells* kCells)>;

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

std::size_t cell_of(const Eigen::Vector2d& pixel, const Box& box) {
  const auto index = [](double x, double low, double high) {
    const double share = high > low ? (x - low) / (high - low) : 0.0;
    return static_cast<std::size_t>(std::clamp(static_cast<int>(kCells * share), 0, kCells - 1));
  };
  return index(pixel.y(), box.low.y(), box.high.y()) * kCells +
         index(pixel.x(), box.low.x(), box.high.x());
}

bool stay(const Features& from, const Features& to, const std::vector<Match>& matches) {
  const auto count = std::ranges::count_if(matches, [&](const Match& match) {
    return (from.pixels[static_cast<std::size_t>(match.from)] -
            to.pixels[static_cast<std::size_t>(match.to)])
               .norm() <= kMostMotionPx;
  });
  return static_cast<double>(count) >= kShareThatStays * static_cast<double>(matches.size());
}

}  // namespace

std::string reason_of_what_stays(const Features& from, const Features& to,
                                 const std::vector<Match>& matches) {
  // Points that come without pixels are no pictures.
  if (matches.empty() || from.pixels.empty() || to.pixels.empty()) return {};
  if (!stay(from, to, matches)) return {};
  const Box box = box_of(from.pixels);
  Counts features{};
  Counts matched{};
  for (const Eigen::Vector2d& pixel : from.pixels) ++features[cell_of(pixel, box)];
  for (const Match& match : matches) {
    ++matched[cell_of(from.pixels[static_cast<std::size_t>(match.from)], box)];
  }
  int cells = 0;
  int agreeing = 0;
  for (std::size_t cell = 0; cell < features.size(); ++cell) {
    if (features[cell] < kLeastFeatures) continue;
    ++cells;
    agreeing += matched[cell] > 0 ? 1 : 0;
  }
  if (agreeing >= kLeastCells * cells) return {};
  return fmt::format(
      "{} matches agree that nothing moves, in {} of {} parts of the picture: something in view "
      "that moves with the camera, half are needed of a vehicle at rest",
      matches.size(), agreeing, cells);
}

}  // namespace fathom
