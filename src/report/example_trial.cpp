#include "example_trial.hpp"

#include <algorithm>

#include "fathom/results/run_index.hpp"
#include "fathom/results/run_series.hpp"
#include "keyframe_series.hpp"
#include "map_frame.hpp"

namespace fathom {
namespace {

constexpr std::size_t kEllipses = 25;

std::vector<Pose> path_of(const ResultStore& store, const RunKey& key, const RunSeries<double>& x_m,
                          const RunSeries<double>& y_m) {
  const auto x = series_of(store, key, x_m);
  const auto y = series_of(store, key, y_m);
  std::vector<Pose> poses;
  if (!x || !y || x->size() != y->size()) return poses;
  for (std::size_t k = 0; k < x->size(); ++k) poses.push_back({(*x)[k], (*y)[k], 0.0});
  return poses;
}

std::vector<ExampleEllipse> ellipses_of(const ResultStore& store, const RunKey& key,
                                        const std::vector<Pose>& poses) {
  std::vector<ExampleEllipse> ellipses;
  const auto xx = series_of(store, key, series::cov_xx);
  const auto xy = series_of(store, key, series::cov_xy);
  const auto yy = series_of(store, key, series::cov_yy);
  const auto has_all = [&](const auto& list) { return list && list->size() == poses.size(); };
  if (!has_all(xx) || !has_all(xy) || !has_all(yy)) return ellipses;
  for (const std::size_t k : thinned(poses.size(), kEllipses)) {
    if (k == 0 || !is_drawable(poses[k])) continue;  // the first is fixed
    Eigen::Matrix2d P;
    P << (*xx)[k], (*xy)[k], (*xy)[k], (*yy)[k];
    if (const auto axes = two_sigma_axes(P)) ellipses.push_back({k, poses[k].position(), *axes});
  }
  return ellipses;
}

std::vector<LoopDecision> loops_of(const ResultStore& store, const RunKey& key) {
  std::vector<LoopDecision> loops;
  const auto from = series_of(store, key, series::loop_from);
  const auto to = series_of(store, key, series::loop_to);
  const auto fate = series_of(store, key, series::loop_fate);
  const auto nis = series_of(store, key, series::loop_nis);
  if (!from || !to || !fate) return loops;
  for (std::size_t i = 0; i < std::min({from->size(), to->size(), fate->size()}); ++i) {
    const auto own = nis && i < nis->size() ? (*nis)[i] : std::nullopt;
    loops.push_back({(*from)[i], (*to)[i], (*fate)[i], own});
  }
  return loops;
}

ExampleTrial example_trial(const ResultStore& store, const CellResults& cell) {
  ExampleTrial example;
  example.trial = first_trial(cell);
  const auto key_of = [&](const std::string& estimator) {
    return RunKey{cell.cell, example.trial.survey, example.trial.trial, estimator};
  };
  example.truth = path_of(store, key_of(kDeadReckoning), series::truth_x_m, series::truth_y_m);
  for (const EstimatorResults& one : cell.estimators) {
    const auto record = std::ranges::find_if(
        one.runs, [&](const RunRecord& r) { return r.key.trial_key() == example.trial; });
    if (record == one.runs.end()) continue;
    const RunKey key = key_of(one.name);
    DrawnRun run{one.name, !is_failed(*record), {}, {}, {}, {}};
    run.poses = path_of(store, key, series::x_m, series::y_m);
    // Dead reckoning's would cover the map.
    if (one.name != kDeadReckoning) run.ellipses = ellipses_of(store, key, run.poses);
    run.loops = loops_of(store, key);
    run.absolute = stored_absolute(store, key, run.poses.size());
    example.runs.push_back(std::move(run));
  }
  return example;
}

}  // namespace

bool DrawnRun::has_ends(const LoopDecision& loop) const {
  return std::max(loop.from, loop.to) < poses.size() && is_drawable(poses[loop.from]) &&
         is_drawable(poses[loop.to]);
}

PlotSeries DrawnRun::series() const {
  const bool may_leave = estimator == kDeadReckoning || !is_done;
  return {display_name(estimator), {}, poses, {}, {}, may_leave, marks_of(absolute)};
}

std::vector<ExampleTrial> example_trials(const ResultStore& store, const StudyResults& results) {
  std::vector<ExampleTrial> examples;
  examples.reserve(results.cells.size());
  for (const CellResults& cell : results.cells) examples.push_back(example_trial(store, cell));
  return examples;
}

}  // namespace fathom
