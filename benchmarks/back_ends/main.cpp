// What every estimator costs, and where it ends, on whole pose graphs: batch and keyframe by
// keyframe, one table each for every graph, and how cost grows with keyframes and loops.
//
//     back_ends [GRAPH.g2o ...] [--estimators sparse_gauss_newton,ceres_pose_graph]
//               [--plugin FILE ...] [--variant 'LABEL=ESTIMATOR KEY=VALUE ...' ...]
//               [--batch-variant '...' ...]
//               [--repeats 5] [--budget 60] [--growth FILE.svg] [--largest 100000]
//     back_ends --maps FILE.svg [--keyframes 1000,10000,…] [--limit 300]
//
// The second way measures one batch solve of large maps, each in a process of its own.
//
// Options of the estimators at their defaults but for variants, batch solves from dead reckoning or
// from what the estimator finds by itself, all through the harness. Totals are CPU times of the
// thread, of the fastest run; what needs more than the budget is given up and reported so. Ceres is
// always among them: figures of two machines can be compared as ratios to it.

#include <algorithm>
#include <array>
#include <cblas.h>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <utility>

#include <CLI/CLI.hpp>

#include "fathom/core/input_error.hpp"
#include "fathom/core/pin_threads.hpp"
#include "fathom/core/program.hpp"
#include "fathom/core/system.hpp"
#include "fathom/estimation/plugin.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/measurements/g2o.hpp"
#include "maps.hpp"
#include "output.hpp"
#include "survey.hpp"

namespace fathom::benchmarks {
namespace {

constexpr const char* kCeres = "ceres_pose_graph";
constexpr std::array<std::size_t, 6> kKeyframes{300, 1000, 3000, 10000, 30000, 100000};
constexpr std::array<std::size_t, 5> kLoops{20, 60, 200, 600, 1800};

struct Settings {
  std::string maps;
  std::string solve;  ///< one solve of a map of this shape, in this process
  int threads = 1;
  MapSettings map;
  std::vector<std::string> graphs;
  std::vector<std::string> estimators;
  std::vector<std::string> plugins;
  std::vector<std::string> variants;
  std::vector<std::string> batch_variants;
  Effort effort;
  std::string growth;
  std::size_t largest = 100000;
};

// "LABEL=ESTIMATOR KEY=VALUE …"
Contender variant(const EstimatorRegistry& registry, const std::string& text) {
  const std::vector<std::string> words = words_of_command(text);
  if (words.empty()) throw InputError("--variant: has no words");
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) throw InputError("--variant: '" + word + "' has no '='");
    pairs.emplace_back(word.substr(0, equals), word.substr(equals + 1));
  }
  Contender contender{pairs[0].first, &registry.find(pairs[0].second), {}};
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    contender.values[pairs[i].first] = OptionValue::scalar(pairs[i].second);
  }
  contender.entry->check({}, contender.values);
  return contender;
}

// A variant with the label of a row stands in its place.
void put(Contender variant, std::vector<Contender>& contenders) {
  const auto same = std::ranges::find(contenders, variant.label, &Contender::label);
  if (same == contenders.end()) {
    contenders.push_back(std::move(variant));
  } else {
    *same = std::move(variant);
  }
}

std::vector<Contender> chosen(const EstimatorRegistry& registry, const Settings& settings) {
  std::vector<Contender> contenders;
  const auto add = [&](const EstimatorEntry& entry) {
    contenders.push_back({entry.name, &entry, {}});
  };
  for (const std::string& name : settings.estimators) add(registry.find(name));
  if (contenders.empty()) {
    for (const EstimatorEntry& entry : registry.entries()) {
      if (!entry.runs_program) add(entry);
    }
  }
  for (const std::string& text : settings.variants) put(variant(registry, text), contenders);
  for (const std::string& text : settings.batch_variants) {
    contenders.push_back(variant(registry, text));
    contenders.back().is_for_batch_alone = true;
  }
  if (std::ranges::none_of(contenders, [](const Contender& c) { return c.label == kCeres; })) {
    add(registry.find(kCeres));
  }
  return contenders;
}

bool runs_in(const Contender& contender, SolveMode mode) {
  return mode == SolveMode::batch ? contender.entry->can_batch : !contender.is_for_batch_alone;
}

LogCosts measure_graph(const std::string& path, const std::vector<Contender>& contenders,
                       const Effort& effort) {
  const MeasurementLog log = read_g2o(path);
  LogCosts costs{std::filesystem::path(path).stem(), log.size(), log.registration_count(), {}};
  for (const SolveMode mode : {SolveMode::batch, SolveMode::incremental}) {
    for (const Contender& contender : contenders) {
      if (!runs_in(contender, mode)) continue;
      costs.costs.push_back(measure(log, contender, mode, effort));
    }
  }
  return costs;
}

LogCosts measure_survey(std::size_t keyframes, std::size_t loops,
                        const std::vector<Contender>& contenders, SolveMode mode, Effort effort,
                        const LogCosts* smaller) {
  effort.covariances = false;
  effort.repeats = 1;
  const MeasurementLog log = parallel_tracks(keyframes, loops);
  LogCosts costs{"survey", log.size(), log.registration_count(), {}};
  for (const Contender& contender : contenders) {
    if (!runs_in(contender, mode)) continue;
    // What was too slow for fewer is not tried with more.
    const std::size_t place = costs.costs.size();
    const bool is_hopeless = smaller != nullptr && smaller->costs[place].gave_up;
    costs.costs.push_back(is_hopeless ? smaller->costs[place]
                                      : measure(log, contender, mode, effort));
  }
  return costs;
}

Growth measure_growth(const Settings& settings, const std::vector<Contender>& contenders) {
  const auto add = [&](std::vector<LogCosts>& logs, std::size_t keyframes, std::size_t loops,
                       SolveMode mode) {
    const LogCosts* smaller = logs.empty() ? nullptr : &logs.back();
    logs.push_back(measure_survey(keyframes, loops, contenders, mode, settings.effort, smaller));
  };
  Growth growth;
  for (const std::size_t keyframes : kKeyframes) {
    if (keyframes > settings.largest) break;
    add(growth.batch, keyframes, keyframes / 3, SolveMode::batch);
    add(growth.by_keyframes, keyframes, keyframes / 3, SolveMode::incremental);
  }
  for (const std::size_t loops : kLoops) {
    add(growth.by_loops, 2000, loops, SolveMode::incremental);
  }
  return growth;
}

void write_chart(const std::string& path, const std::string& svg) {
  std::ofstream file(path);
  file << svg;
  if (!file.flush()) throw InputError(path + ": cannot be written");
}

void run_maps(const Settings& settings) {
  if (!settings.solve.empty()) {
    const MapSolver solver{settings.estimators.at(0), settings.threads};
    std::printf("%s", solve_here(settings.solve, settings.map.keyframes.at(0), solver).c_str());
    return;
  }
  const std::vector<MapCost> costs = measure_maps(settings.map);
  std::printf("%s", markdown(costs, settings.map.solvers).c_str());
  write_chart(settings.maps, chart(costs, settings.map.solvers));
}

void run(const Settings& settings) {
  if (!settings.maps.empty() || !settings.solve.empty()) return run_maps(settings);
  EstimatorRegistry registry = builtin_estimators();
  registry.add(command_entry());
  for (const std::string& file : settings.plugins) load_plugin(file, registry);
  const std::vector<Contender> contenders = chosen(registry, settings);
  std::printf("BLAS on %d thread, OpenMP not nested: one thread in all. Totals are its CPU time.\n",
              openblas_get_num_threads());
  for (const std::string& graph : settings.graphs) {
    std::printf("%s", markdown(measure_graph(graph, contenders, settings.effort)).c_str());
    std::fflush(stdout);
  }
  if (settings.growth.empty()) return;
  const Growth growth = measure_growth(settings, contenders);
  std::printf("%s", markdown(growth).c_str());
  write_chart(settings.growth, chart(growth));
}

void add_options(CLI::App& app, Settings& settings) {
  app.add_option("graphs", settings.graphs, "g2o files")->check(CLI::ExistingFile);
  app.add_option("--estimators", settings.estimators, "those to run; default: all; Ceres always")
      ->delimiter(',');
  app.add_option("--plugin", settings.plugins, "a plug-in whose estimators are run, too");
  app.add_option("--variant", settings.variants,
                 "'LABEL=ESTIMATOR KEY=VALUE ...': one more row, an estimator with these options");
  app.add_option("--batch-variant", settings.batch_variants, "the same, in batch alone");
  app.add_option("--repeats", settings.effort.repeats, "runs, of which the fastest counts")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--budget", settings.effort.budget_s,
                 "s of CPU time for all repeats of an estimator on a graph")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--growth", settings.growth, "measure growth, too, and draw it to this SVG file");
  app.add_option("--largest", settings.largest, "keyframes that growth goes up to")
      ->capture_default_str();
  app.add_option("--maps", settings.maps,
                 "measure batch solves of large maps, and draw them to this SVG file");
  app.add_option("--keyframes", settings.map.keyframes, "sizes of those maps")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--limit", settings.map.limit_s, "s that a process of one solve may take")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--solve", settings.solve,
                 "one solve of a map of this shape by the first of --estimators, as a line")
      ->check(CLI::IsMember(kShapes));
  app.add_option("--threads", settings.threads, "of --solve; 1")->check(CLI::PositiveNumber);
}

}  // namespace
}  // namespace fathom::benchmarks

int main(int argc, char** argv) try {
  fathom::pin_threads();
  fathom::keep_free_memory();
  fathom::benchmarks::Settings settings;
  settings.map.program = std::filesystem::read_symlink("/proc/self/exe");
  CLI::App app("What the estimators cost on whole pose graphs");
  fathom::benchmarks::add_options(app, settings);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  }
  fathom::benchmarks::run(settings);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "back_ends: error: %s\n", error.what());
  return 2;
}
