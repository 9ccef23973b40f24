// How often, how well and how honestly pairs of pictures are registered, on floors and under
// conditions whose truth is known, beside OpenCV's own functions on the same features.
//
//     registration_benchmark [--floors ripples,mud] [--conditions clean,haze] [--buckets 3,4,5]
//                            [--pairs-per-cell 5] [--negatives 200] [--json FILE] [--speed]
//
// One thread for BLAS, OpenMP and OpenCV each; `--jobs` pairs at a time. Times are comparable with
// one job alone.

#include <cstdio>
#include <fstream>

#include <CLI/CLI.hpp>
#include <opencv2/core.hpp>

#include "fathom/core/input_error.hpp"
#include "fathom/core/pin_threads.hpp"
#include "output.hpp"

namespace fathom::benchmarks {
namespace {

void add_options(CLI::App& app, Settings& settings) {
  app.add_option("--floors", settings.floors, "kinds of sea floor, and tiles; 'none': only --world")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--world", settings.worlds, "a picture of a floor, FILE:METRES_PER_PIXEL");
  app.add_option("--conditions", settings.conditions, "those to run; default: all")->delimiter(',');
  app.add_option("--buckets", settings.buckets, "tenths of overlap, 0 to 9; default: all")
      ->delimiter(',')
      ->check(CLI::Range(0, 9));
  app.add_option("--pairs-per-cell", settings.pairs_per_cell, "per floor, condition and bucket")
      ->capture_default_str();
  app.add_option("--negatives", settings.negatives, "pairs without overlap, per floor")
      ->capture_default_str();
  app.add_option("--pool", settings.pool, "pictures per floor that negatives are made of")
      ->capture_default_str();
  app.add_option("--seed", settings.seed, "of poses, floors and all draws")->capture_default_str();
  app.add_option("--jobs", settings.jobs, "pairs at a time")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_flag("!--skip-opencv", settings.opencv, "leave OpenCV's functions out");
  app.add_flag("--speed", settings.speed, "time matching and solving on one thread, too");
  app.add_flag("--plain", settings.plain, "decide by the paper's count of inliers instead");
  app.add_option("--set", settings.set,
                 "KEY=VALUE: an option of the registration, as under front_end");
  app.add_option("--json", settings.json, "write all figures to this file");
}

std::vector<test::Condition> chosen_conditions(const Settings& settings) {
  if (settings.conditions.empty()) return test::conditions();
  std::vector<test::Condition> chosen;
  for (const std::string& name : settings.conditions) {
    chosen.push_back(test::condition_named(name));
  }
  return chosen;
}

void run_floor(const Floor& floor, const std::vector<test::Condition>& conditions,
               Results& results) {
  const Settings& settings = results.settings;
  std::vector<CellSummary> cells;
  for (const test::Condition& condition : conditions) {
    if (settings.pairs_per_cell == 0) break;
    std::fprintf(stderr, "%s, %s\n", floor.name.c_str(), condition.name.c_str());
    const Cell cell = run_cell(floor, condition, settings);
    cells.push_back(summarise(cell, buckets_of(settings).size()));
  }
  std::printf("%s", markdown(cells, settings).c_str());
  std::fflush(stdout);
  results.cells.insert(results.cells.end(), cells.begin(), cells.end());
  if (settings.negatives > 0) results.negatives.push_back(run_negatives(floor, settings));
  if (settings.speed) results.speeds.emplace_back(floor.name, measure_speed(floor, settings));
}

void run(Results& results) {
  const Settings& settings = results.settings;
  const std::vector<test::Condition> conditions = chosen_conditions(settings);
  for (std::size_t i = 0; i < floor_names(settings).size(); ++i) {
    cv::setNumThreads(static_cast<int>(settings.jobs));
    const Floor floor = make_floor(settings, i);
    cv::setNumThreads(1);
    run_floor(floor, conditions, results);
  }
  std::printf("%s%s", markdown(results.negatives, settings).c_str(),
              markdown(results.speeds).c_str());
  if (settings.json.empty()) return;
  std::ofstream file(settings.json);
  file << json_text(results);
  if (!file.flush()) throw InputError(settings.json + ": cannot be written");
}

}  // namespace
}  // namespace fathom::benchmarks

int main(int argc, char** argv) try {
  fathom::pin_threads();
  fathom::benchmarks::Results results;
  CLI::App app("Registration of pairs of pictures whose motion is known");
  fathom::benchmarks::add_options(app, results.settings);
  CLI11_PARSE(app, argc, argv);
  if (results.settings.floors == std::vector<std::string>{"none"}) results.settings.floors.clear();
  fathom::benchmarks::run(results);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "registration_benchmark: error: %s\n", error.what());
  return 2;
}
