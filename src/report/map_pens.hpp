#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "canvas.hpp"
#include "fathom/report/trajectory_plot.hpp"

namespace fathom {

inline constexpr std::string_view kTrueLine = "ground truth";

/// By series, the pen of its line. Where lines cross all are seen: the earlier is the broader. A
/// dashed line lets through what is below it.
std::vector<Pen> map_pens(std::span<const PlotSeries> all);

/// Estimates that are nowhere farther than this from the first of them are drawn as one line, on
/// which their colours take turns: the first is whole, and each other has its dash on top of it.
/// Whether there are any.
bool take_turns(std::span<const PlotSeries> all, double within_m, std::vector<Pen>& pens);

}  // namespace fathom
