#include "example_page.hpp"

#include <algorithm>
#include <array>

#include <Eigen/Eigenvalues>

#include "absolute_marks.hpp"
#include "keyframe_series.hpp"
#include "map_frame.hpp"
#include "page_numbers.hpp"
#include "trajectory_map.hpp"

namespace fathom {
namespace {

using Json = nlohmann::ordered_json;

std::string words_of(LoopFate fate) {
  switch (fate) {
    case LoopFate::used:
      return "used";
    case LoopFate::rejected:
      return "rejected by the gate";
    case LoopFate::lost:
      break;
  }
  return "lost with a failed update";
}

// The line is broken at poses that cannot be drawn.
Json path_json(const std::vector<Pose>& poses, std::size_t most) {
  if (poses.empty()) return {};
  const std::vector<std::size_t> places = thinned(poses.size(), most);
  Json json{{"keyframe", places}, {"x_m", Json::array()}, {"y_m", Json::array()}};
  for (const std::size_t k : places) {
    const bool is_drawn = is_drawable(poses[k]);
    json["x_m"].push_back(is_drawn ? page_number(poses[k].x) : Json());
    json["y_m"].push_back(is_drawn ? page_number(poses[k].y) : Json());
  }
  return json;
}

Json ellipses_json(const std::vector<ExampleEllipse>& ellipses) {
  Json json = Json::array();
  for (const ExampleEllipse& one : ellipses) {
    json.push_back({one.keyframe, page_number(one.centre.x()), page_number(one.centre.y()),
                    page_number(one.axes(0, 0)), page_number(one.axes(0, 1)),
                    page_number(one.axes(1, 0)), page_number(one.axes(1, 1))});
  }
  return json;
}

// The places of those drawn, rising. Evenly thinned; loops that were not used are fewer and say
// more, so half of all places are theirs.
std::vector<std::size_t> drawn_loops(const std::vector<LoopDecision>& loops, std::size_t most) {
  std::vector<std::size_t> used;
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    (loops[i].fate == LoopFate::used ? used : others).push_back(i);
  }
  const std::size_t of_others =
      std::min(others.size(), std::max(most / 2, most - std::min(most, used.size())));
  std::vector<std::size_t> drawn = picked(others, thinned(others.size(), of_others));
  const auto more = picked(used, thinned(used.size(), most - of_others));
  drawn.insert(drawn.end(), more.begin(), more.end());
  std::ranges::sort(drawn);
  return drawn;
}

// With the places of its ends, which may have been thinned out of the path, where there are any.
Json loop_json(const LoopDecision& loop, const DrawnRun& run) {
  Json json{loop.from, loop.to, name_of(loop.fate), page_number(loop.nis)};
  if (!run.has_ends(loop)) return json;
  for (const Pose* pose : {&run.poses[loop.from], &run.poses[loop.to]}) {
    json.push_back(page_number(pose->x));
    json.push_back(page_number(pose->y));
  }
  return json;
}

void add_loops(Json& json, const DrawnRun& run, std::size_t most) {
  json["loops_in_all"] = Json::object();
  for (const LoopFate fate : kLoopFates) {
    json["loops_in_all"][name_of(fate)] = std::ranges::count(run.loops, fate, &LoopDecision::fate);
  }
  json["loops"] = Json::array();
  for (const std::size_t i : drawn_loops(run.loops, most)) {
    json["loops"].push_back(loop_json(run.loops[i], run));
  }
}

// One absolute measurement at where its keyframe was estimated to be.
Json absolute_json(const StoredAbsolute& one, const Pose& at) {
  Json json{{"keyframe", one.mark.pose},
            {"fate", name_of(one.fate)},
            {"weight", page_number(one.weight)},
            {"left_out", !one.mark.is_kept},
            {"at_m", {page_number(at.x), page_number(at.y)}}};
  if (one.nis) json["nis"] = page_number(*one.nis);
  const MeasuredParts& measured = one.mark.measured;
  if (measured.position) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(measured.position_covariance);
    const Eigen::Vector2d sigma = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    json["fix_m"] = {page_number(measured.position->x()), page_number(measured.position->y())};
    json["fix_sigma_m"] = {page_number(sigma.y()), page_number(sigma.x())};
    json["off_m"] = page_number((*measured.position - at.position()).norm());
  }
  if (measured.heading_rad) {
    json["heading_rad"] = page_number(*measured.heading_rad);
    json["sigma_rad"] = page_number(measured.heading_sigma_rad);
  }
  return json;
}

bool has_place(const StoredAbsolute& one, const Pose& at) {
  const auto& fix = one.mark.measured.position;
  return is_drawable(at) && (!fix || is_drawable({fix->x(), fix->y(), 0.0}));
}

// Those that the map shows, and how many there are of each kind: kept and left out.
void add_absolute(Json& json, const DrawnRun& run, std::size_t most) {
  std::array<std::size_t, 2> fixes{};
  std::array<std::size_t, 2> headings{};
  for (const StoredAbsolute& one : run.absolute) {
    ++(one.mark.measured.position ? fixes : headings)[one.mark.is_kept ? 0 : 1];
  }
  json["absolute"] = Json::array();
  json["absolute_in_all"] = {{"fixes", fixes}, {"headings", headings}};
  for (const std::size_t i : drawn_marks(marks_of(run.absolute), MarkLimits().within(most))) {
    const StoredAbsolute& one = run.absolute[i];
    const Pose& at = run.poses[one.mark.pose];
    if (has_place(one, at)) json["absolute"].push_back(absolute_json(one, at));
  }
}

// By the rule of the figure's map, with the fixes of all estimators; null where nothing can be
// drawn.
Json extent_json(const ExampleTrial& example) {
  std::vector<PlotSeries> all;
  for (const DrawnRun& run : example.runs) all.push_back(run.series());
  if (!example.truth.empty()) all.push_back({"", {}, example.truth, {}, {}, false});
  const Eigen::AlignedBox2d extent = map_extent(all);
  if (extent.isEmpty()) return {};
  const auto along = [&](int axis) -> Json {
    return {page_number(extent.min()[axis]), page_number(extent.max()[axis])};
  };
  return {{"x_m", along(0)}, {"y_m", along(1)}};
}

}  // namespace

Json example_json(const ExampleTrial& example, const CellResults& cell,
                  const ExampleLimits& limits) {
  Json json{{"survey", example.trial.survey},
            {"trial", example.trial.trial},
            {"text", example_text(cell, example.trial)},
            {"extent", extent_json(example)},
            {"truth", path_json(example.truth, limits.keyframes)}};
  json["estimators"] = Json::array();
  for (const DrawnRun& run : example.runs) {
    Json one{{"name", run.estimator},
             {"path", path_json(run.poses, limits.keyframes)},
             {"ellipses", ellipses_json(run.ellipses)}};
    add_loops(one, run, limits.loops);
    add_absolute(one, run, limits.absolute);
    json["estimators"].push_back(std::move(one));
  }
  return json;
}

Json fates_json() {
  Json json = Json::object();
  for (const LoopFate fate : kLoopFates) json[name_of(fate)] = words_of(fate);
  return json;
}

}  // namespace fathom
