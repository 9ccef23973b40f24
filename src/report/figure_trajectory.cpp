#include <memory>

#include "study_figures.hpp"
#include "trajectory_map.hpp"

namespace fathom {
namespace {

// So many loops at most, evenly thinned: more would be one grey area, and a large file.
constexpr std::size_t kMostLoops = 5000;

void add_loops(PlotSeries& series, const DrawnRun& run) {
  for (const LoopDecision& loop : run.loops) {
    if (loop.fate == LoopFate::used && run.has_ends(loop)) {
      series.loops.emplace_back(loop.from, loop.to);
    }
  }
  series.loops = picked(series.loops, thinned(series.loops.size(), kMostLoops));
}

TrajectoryPlot plot_of(const ExampleTrial& example,
                       const std::map<std::string, LineStyle>& styles) {
  TrajectoryPlot plot;
  bool has_loops = false;
  for (const DrawnRun& run : example.runs) {
    PlotSeries series = run.series();
    if (series.poses.empty()) continue;
    series.style = styles.at(run.estimator);
    if (run.estimator != kDeadReckoning && !has_loops) {
      add_loops(series, run);
      has_loops = !series.loops.empty();
    }
    plot.series.push_back(std::move(series));
  }
  keep_one_set_of_marks(plot.series);
  if (!plot.series.empty() && !example.truth.empty()) {
    plot.series.insert(plot.series.begin(),
                       {"ground truth", ground_truth_style(), example.truth, {}, {}, false});
  }
  return plot;
}

}  // namespace

void add_trajectory_figures(const ChartInput& input, std::vector<StudyFigure>& figures) {
  const StudyResults& results = input.results;
  const auto styles = line_styles(results.study);
  for (std::size_t i = 0; i < results.cells.size(); ++i) {
    const CellResults& cell = results.cells[i];
    const ExampleTrial& example = input.examples[i];
    const auto plot = std::make_shared<const TrajectoryPlot>(plot_of(example, styles));
    if (plot->series.empty()) continue;
    const std::string conditions = example_text(cell, example.trial) + " of " + cell_caption(cell);
    const FigureLayout layout({220.0}, TrajectoryMap(*plot).legend(), conditions);
    figures.push_back({figure_title("trajectories", cell.label, results.cells.size() == 1),
                       layout.height(), [plot, layout](Canvas& canvas) {
                         TrajectoryMap(*plot).draw(canvas, layout.chart(0));
                         layout.draw_footer(canvas);
                       }});
  }
}

}  // namespace fathom
