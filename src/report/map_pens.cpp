#include "map_pens.hpp"

#include <algorithm>
#include <cstddef>

#include "map_frame.hpp"

namespace fathom {
namespace {

constexpr double kThinnest = 0.9;
constexpr double kBroadest = 2.1;
constexpr double kShared = 1.4;
constexpr double kTurn = 7.0;  // length of a colour

bool are_together(const PlotSeries& a, const PlotSeries& b, double within_m) {
  return std::ranges::equal(a.poses, b.poses, [&](const Pose& one, const Pose& other) {
    if (!is_drawable(one) || !is_drawable(other)) return is_drawable(one) == is_drawable(other);
    return (one.position() - other.position()).norm() <= within_m;
  });
}

std::vector<std::vector<std::size_t>> groups_of(std::span<const PlotSeries> all, double within_m) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == kTrueLine || all[i].poses.size() < 2) continue;
    const auto group = std::ranges::find_if(groups, [&](const std::vector<std::size_t>& one) {
      return are_together(all[one.front()], all[i], within_m);
    });
    if (group == groups.end()) {
      groups.push_back({i});
    } else {
      group->push_back(i);
    }
  }
  return groups;
}

}  // namespace

std::vector<Pen> map_pens(std::span<const PlotSeries> all) {
  std::vector<Pen> pens(all.size());
  double width = kThinnest;
  for (std::size_t i = all.size(); i-- > 0;) {
    const LineStyle& style = all[i].style;
    pens[i] = {style.colour, style.dashes.empty() ? width : kThinnest, style.dashes, 1.0};
    if (all[i].name == kTrueLine) {
      pens[i] = {tint(style.colour, 0.45), std::max(2.0, width + 1.0), {}, 1.0};
    }
    if (style.dashes.empty()) width = std::min(width + 0.4, kBroadest);
  }
  return pens;
}

bool take_turns(std::span<const PlotSeries> all, double within_m, std::vector<Pen>& pens) {
  bool do_any = false;
  for (const std::vector<std::size_t>& group : groups_of(all, within_m)) {
    if (group.size() < 2) continue;
    do_any = true;
    const auto others = static_cast<double>(group.size() - 1);
    for (std::size_t place = 0; place < group.size(); ++place) {
      Pen& pen = pens[group[place]];
      pen.width = kShared;
      pen.dashes.clear();
      if (place == 0) continue;
      pen.dashes = {kTurn, kTurn * others};
      pen.dash_offset = -kTurn * static_cast<double>(place);
    }
  }
  return do_any;
}

}  // namespace fathom
