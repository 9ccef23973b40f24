#include "sweep_lines.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "fathom/configuration/axis_words.hpp"

namespace fathom {
namespace {

// Numbers lie where they are, other values side by side.
std::vector<double> positions_of(const std::vector<std::string>& labels) {
  if (auto numbers = numeric_positions(labels)) return *std::move(numbers);
  std::vector<double> positions;
  for (std::size_t i = 0; i < labels.size(); ++i) positions.push_back(static_cast<double>(i));
  return positions;
}

void add_values(SweepLine& line, const EstimatorResults& one, const EstimatorSeries& series,
                const std::string& metric, double x) {
  if (const auto found = one.metrics.find(metric); found != one.metrics.end()) {
    const Moments& moments = found->second.moments;
    const BandedMean error = banded(moments.mean, moments.standard_deviation);
    line.mean.emplace_back(x, error.mean);
    line.low.emplace_back(x, error.low);
    line.high.emplace_back(x, error.high);
  }
  if (!series.bounds) return;
  line.empirical.emplace_back(x, series.bounds->empirical_m);
  if (series.bounds->estimated_m) line.estimated.emplace_back(x, *series.bounds->estimated_m);
}

}  // namespace

std::vector<SweepLine> sweep_lines(const ChartInput& input, const Sweep& sweep,
                                   const std::string& metric) {
  std::vector<SweepLine> lines;
  for (const std::size_t place : sweep.cells) {
    const CellResults& cell = input.results.cells[place];
    const double at = sweep.positions[input.results.study.places_of(cell.cell)[sweep.axis]];
    const auto count = static_cast<double>(cell.estimators.size());
    for (std::size_t i = 0; i < cell.estimators.size(); ++i) {
      // Beside each other where each has a bar.
      const double beside =
          std::min(0.06, 0.5 / count) * (static_cast<double>(i) - 0.5 * (count - 1.0));
      const double x = sweep.is_numeric ? at : at + beside;
      auto line = std::find_if(lines.begin(), lines.end(), [&](const auto& known) {
        return known.estimator == cell.estimators[i].name;
      });
      if (line == lines.end()) {
        line = lines.insert(line, SweepLine{cell.estimators[i].name, {}, {}, {}, {}, {}});
      }
      add_values(*line, cell.estimators[i], input.series[place][i], metric, x);
    }
  }
  return lines;
}

std::vector<Sweep> sweeps_along(std::size_t axis, const StudyResults& results) {
  std::map<std::vector<std::size_t>, Sweep> sweeps;
  for (std::size_t i = 0; i < results.cells.size(); ++i) {
    std::vector<std::size_t> others = results.study.places_of(results.cells[i].cell);
    others[axis] = 0;
    Sweep& sweep = sweeps[others];
    sweep.axis = axis;
    sweep.positions = positions_of(results.study.axes[axis].labels);
    sweep.is_numeric = numeric_positions(results.study.axes[axis].labels).has_value();
    sweep.cells.push_back(i);
  }
  std::vector<Sweep> list;
  for (auto& [others, sweep] : sweeps) {
    if (sweep.cells.size() < 2) continue;
    // A line goes from number to number, in whatever order they were given.
    const std::vector<double>& positions = sweep.positions;
    std::ranges::stable_sort(sweep.cells, {}, [&](std::size_t cell) {
      return positions[results.study.places_of(results.cells[cell].cell)[axis]];
    });
    list.push_back(std::move(sweep));
  }
  return list;
}

std::string name_of_others(const Sweep& sweep, const StudyResults& results) {
  const StudyDescription& study = results.study;
  const auto places = study.places_of(results.cells[sweep.cells.front()].cell);
  std::string name;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i != sweep.axis) name += " " + study.axes[i].name + " " + study.axes[i].labels[places[i]];
  }
  return name;
}

}  // namespace fathom
