#include "example_trial.hpp"

#include <algorithm>
#include <array>

#include "absolute_marks.hpp"
#include "fathom/results/run_series.hpp"
#include "keyframe_series.hpp"
#include "page_numbers.hpp"
#include "stored_absolute.hpp"

namespace fathom {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kEllipses = 25;

Json path_json(const ResultStore& store, const RunKey& key, const RunSeries<double>& x_m,
               const RunSeries<double>& y_m, std::size_t most) {
  const auto x = series_of(store, key, x_m);
  const auto y = series_of(store, key, y_m);
  if (!x || !y || x->size() != y->size()) return {};
  const std::vector<std::size_t> places = thinned(x->size(), most);
  return {{"keyframe", places},
          {"x_m", page_numbers(picked(*x, places))},
          {"y_m", page_numbers(picked(*y, places))}};
}

// Centre and covariance of some keyframes.
Json ellipses_json(const ResultStore& store, const RunKey& key) {
  Json json = Json::array();
  std::vector<std::vector<double>> all;
  for (const RunSeries<double>& one :
       {series::x_m, series::y_m, series::cov_xx, series::cov_xy, series::cov_yy}) {
    const auto values = series_of(store, key, one);
    if (!values || (!all.empty() && values->size() != all.front().size())) return json;
    all.push_back(*values);
  }
  for (const std::size_t k : thinned(all.front().size(), kEllipses)) {
    if (k == 0) continue;  // fixed
    json.push_back(Json::array({k}));
    for (const auto& values : all) json.back().push_back(page_number(values[k]));
  }
  return json;
}

// What the page says of the loops of one run: those that it draws, each [from, to, fate, NIS or
// null], and how many there are of every fate.
struct ExampleLoops {
  Json drawn = Json::array();
  std::array<std::size_t, 3> counts{};
};

// Evenly thinned; loops that were not used are fewer and say more, so half of all places are
// theirs.
std::vector<std::size_t> drawn_loops(const std::vector<std::size_t>& used,
                                     const std::vector<std::size_t>& others, std::size_t most) {
  const std::size_t of_others =
      std::min(others.size(), std::max(most / 2, most - std::min(most, used.size())));
  std::vector<std::size_t> drawn = picked(others, thinned(others.size(), of_others));
  const auto more = picked(used, thinned(used.size(), most - of_others));
  drawn.insert(drawn.end(), more.begin(), more.end());
  std::ranges::sort(drawn);
  return drawn;
}

ExampleLoops example_loops(const ResultStore& store, const RunKey& key, std::size_t most) {
  ExampleLoops loops;
  const auto from = series_of(store, key, series::loop_from);
  const auto to = series_of(store, key, series::loop_to);
  const auto fate = series_of(store, key, series::loop_fate);
  const auto nis = series_of(store, key, series::loop_nis);
  if (!from || !to || !fate) return loops;
  const std::size_t count = std::min({from->size(), to->size(), fate->size()});
  std::vector<std::size_t> used;
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < count; ++i) {
    ++loops.counts[static_cast<std::size_t>((*fate)[i])];
    ((*fate)[i] == LoopFate::used ? used : others).push_back(i);
  }
  for (const std::size_t i : drawn_loops(used, others, most)) {
    const bool has_nis = nis && i < nis->size() && (*nis)[i];
    loops.drawn.push_back({page_number(number_of((*from)[i])), page_number(number_of((*to)[i])),
                           page_number(number_of((*fate)[i])),
                           has_nis ? page_number(*(*nis)[i]) : Json()});
  }
  return loops;
}

// Where the loops of one run begin and end: their keyframes may have been thinned out of the path.
Json loop_ends_json(const ResultStore& store, const RunKey& key, const Json& loops) {
  const auto x = series_of(store, key, series::x_m);
  const auto y = series_of(store, key, series::y_m);
  Json json = Json::array();
  if (!x || !y) return json;
  for (const Json& loop : loops) {
    const auto from = loop[0].get<std::size_t>();
    const auto to = loop[1].get<std::size_t>();
    if (std::max(from, to) >= std::min(x->size(), y->size())) {
      json.push_back(nullptr);
      continue;
    }
    json.push_back({page_number((*x)[from]), page_number((*y)[from]), page_number((*x)[to]),
                    page_number((*y)[to])});
  }
  return json;
}

// One absolute measurement; `x` and `y` are where its keyframe was estimated to be.
Json absolute_json(const StoredAbsolute& one, double x, double y) {
  Json json{{"keyframe", one.mark.pose},
            {"fate", static_cast<int>(one.fate)},
            {"weight", page_number(one.weight)},
            {"at_m", {page_number(x), page_number(y)}}};
  if (one.nis) json["nis"] = page_number(*one.nis);
  const MeasuredParts& measured = one.mark.measured;
  if (measured.position) {
    const Eigen::Matrix2d& C = measured.position_covariance;
    json["fix_m"] = {page_number(measured.position->x()), page_number(measured.position->y())};
    json["fix_cov_m2"] = {page_number(C(0, 0)), page_number(C(0, 1)), page_number(C(1, 1))};
  }
  if (measured.heading_rad) {
    json["heading_rad"] = page_number(*measured.heading_rad);
    json["sigma_rad"] = page_number(measured.heading_sigma_rad);
  }
  return json;
}

// Those that the map shows, and how many there are of each kind: kept and left out.
void add_absolute(Json& json, const ResultStore& store, const RunKey& key, std::size_t most) {
  json["absolute"] = Json::array();
  json["absolute_in_all"] = {{"fixes", {0, 0}}, {"headings", {0, 0}}};
  const auto x = series_of(store, key, series::x_m);
  const auto y = series_of(store, key, series::y_m);
  if (!x || !y) return;
  const auto all = stored_absolute(store, key, std::min(x->size(), y->size()));
  for (const StoredAbsolute& one : all) {
    Json& kinds = json["absolute_in_all"][one.mark.measured.position ? "fixes" : "headings"];
    Json& count = kinds[one.mark.is_kept ? 0 : 1];
    count = count.get<int>() + 1;
  }
  for (const std::size_t i : drawn_marks(marks_of(all), MarkLimits().within(most))) {
    const std::size_t k = all[i].mark.pose;
    json["absolute"].push_back(absolute_json(all[i], (*x)[k], (*y)[k]));
  }
}

}  // namespace

Json example_trial(const ResultStore& store, const CellResults& cell, const ExampleLimits& limits) {
  const TrialKey trial = first_trial(cell);
  const RunKey baseline{cell.cell, trial.survey, trial.trial, kDeadReckoning};
  Json json{{"survey", trial.survey},
            {"trial", trial.trial},
            {"text", example_text(cell, trial)},
            {"truth",
             path_json(store, baseline, series::truth_x_m, series::truth_y_m, limits.keyframes)}};
  json["estimators"] = Json::array();
  for (const EstimatorResults& one : cell.estimators) {
    const RunKey key{cell.cell, trial.survey, trial.trial, one.name};
    const Json path = path_json(store, key, series::x_m, series::y_m, limits.keyframes);
    const ExampleLoops loops = example_loops(store, key, limits.loops);
    const auto run = std::find_if(one.runs.begin(), one.runs.end(),
                                  [&trial](const auto& r) { return r.key.trial_key() == trial; });
    if (run == one.runs.end()) continue;
    json["estimators"].push_back(
        {{"name", one.name},
         {"outcome", run->outcome},
         {"path", path},
         // Dead reckoning's would cover the map.
         {"ellipses", one.name == kDeadReckoning ? Json::array() : ellipses_json(store, key)},
         {"loops_in_all", loops.counts},
         {"loops", loops.drawn},
         {"loop_ends_m", loop_ends_json(store, key, loops.drawn)}});
    add_absolute(json["estimators"].back(), store, key, limits.absolute);
  }
  return json;
}

}  // namespace fathom
