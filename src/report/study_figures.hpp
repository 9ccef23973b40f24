#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "chart_frame.hpp"
#include "chart_legend.hpp"
#include "chart_rows.hpp"
#include "study_styles.hpp"

namespace fathom {

/// A figure for print, as wide as a column (89 mm).
struct StudyFigure {
  std::string name;  ///< of its file, without ending
  double height = 0.0;
  std::function<void(Canvas&)> draw;
};

inline constexpr double kFigureWidth = 252.0;

/// All figures of a study: those that its results have something for. The input must outlive them.
std::vector<StudyFigure> study_figures(const ChartInput& input);

// Its parts. Each appends.
/// `error_by_AXIS`, one for each place on the other axes: mean of the accuracy metric shown with
/// its 2σ band over trials, empirical and estimated 2σ of the position below.
void add_sweep_figures(const ChartInput& input, std::vector<StudyFigure>& figures);
/// `regime_map`, one for each place on the axes after the first two: the accuracy metric shown, of
/// which less must be better, relative to the best estimator over two axes, a map an estimator; and
/// which is the cheapest of the best. Where nothing ranks, the means themselves.
void add_regime_figures(const ChartInput& input, std::vector<StudyFigure>& figures);
/// `nees_CELL`: NEES / 3 over keyframes, mean over trials, with its χ² interval.
void add_nees_figures(const ChartInput& input, std::vector<StudyFigure>& figures);
/// `trajectories_CELL`: those of the lowest trial, with the loops of the first estimator used,
/// and the absolute measurements of the first that left one out.
void add_trajectory_figures(const ChartInput& input, std::vector<StudyFigure>& figures);
/// `accuracy_against_cost_CELL`: the accuracy metric shown and the first cost.
void add_cost_figures(const ChartInput& input, std::vector<StudyFigure>& figures);

/// What the name of a figure's file is made from: "trajectories" in a study of one cell, else
/// "trajectories separation 5".
std::string figure_title(const std::string& what, const std::string& label, bool alone);

/// One or more charts one below the other, then the legend and the conditions in small print: each
/// takes the height that it needs.
class FigureLayout {
 public:
  FigureLayout(std::vector<double> chart_heights, std::vector<LegendEntry> legend,
               const std::string& conditions);

  double height() const;
  Box chart(std::size_t place) const;
  void draw_footer(Canvas& canvas) const;

 private:
  double footer_top() const;

  std::vector<double> chart_heights_;
  ChartLegend legend_;
  std::vector<std::string> conditions_;
};

/// A metric as the title of an axis.
AxisTitle axis_title(const std::string& metric);

/// The study's first metric that is a cost or is none, and of which an estimator has a value;
/// nothing without one.
std::optional<std::string> first_metric(const StudyResults& results, bool cost);

/// The accuracy metric that charts show: the one that ranks, else the first.
std::optional<std::string> accuracy_shown(const StudyResults& results);

}  // namespace fathom
