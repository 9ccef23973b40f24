// How back ends stand false loops: graphs with a share of false ones added, each solved as a batch
// and compared with the optimum of the same graph without them. Prints a Markdown table.
//
//   wrong_loops [--seeds N] [--shares 0.1,0.3,0.5] [--kinds random,local,grouped]
//               [--back-ends NAME,…] GRAPH.g2o …

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "fathom/estimators/builtin.hpp"
#include "fathom/measurements/g2o.hpp"
#include "fathom/measurements/spoil.hpp"

namespace fathom {
namespace {

struct BackEnd {
  std::string name;
  std::string type;
  std::vector<std::pair<std::string, std::string>> options;
};

std::vector<BackEnd> back_ends() {
  std::vector<BackEnd> all{{"plain", "sparse_gauss_newton", {}}};
  for (const char* loss : {"huber", "cauchy", "dcs", "geman_mcclure", "truncated"}) {
    all.push_back({loss, "sparse_gauss_newton", {{"loss", loss}}});
  }
  all.push_back(
      {"gnc", "sparse_gauss_newton", {{"loss", "geman_mcclure"}, {"graduation", "convex"}}});
  all.push_back({"ceres", "ceres_pose_graph", {}});
  for (const char* loss : {"huber", "cauchy", "dcs", "geman_mcclure"}) {
    all.push_back({std::string("ceres_") + loss, "ceres_pose_graph", {{"loss", loss}}});
  }
  return all;
}

struct Flags {
  int seeds = 3;
  std::vector<double> shares{0.1, 0.3, 0.5};
  std::vector<std::string> kinds{"random", "local", "grouped"};
  std::vector<std::string> back_ends{"plain",         "huber", "cauchy",   "dcs",
                                     "geman_mcclure", "gnc",   "truncated"};
  std::vector<std::string> graphs;
};

struct Solved {
  std::vector<Pose> poses;
  std::vector<double> weights;
  double ms = 0.0;
};

Solved solve(const MeasurementLog& log, const BackEnd& back_end) {
  EstimatorValues values;
  for (const auto& [key, value] : back_end.options) values[key] = OptionValue::scalar(value);
  const auto begin = std::chrono::steady_clock::now();
  const auto estimator =
      builtin_estimators().find(back_end.type).create({log.origin(), SolveMode::batch}, values);
  for (std::size_t k = 1; k < log.size(); ++k) {
    estimator->add_keyframe(log.arrival(k).step);
    if (!log.arrival(k).registrations.empty()) {
      estimator->close_loops(log.arrival(k).registrations);
    }
  }
  estimator->finish();
  Solved solved{poses_of(*estimator), estimator->loop_weights(), 0.0};
  solved.ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  if (solved.weights.empty()) solved.weights.assign(log.registration_count(), 1.0);
  return solved;
}

double mean_distance_m(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k].position() - b[k].position()).norm();
  return sum / static_cast<double>(a.size());
}

FalseLoopKind kind_of(const std::string& name) {
  for (const FalseLoopKind kind : {FalseLoopKind::local, FalseLoopKind::grouped}) {
    if (name_of(kind) == name) return kind;
  }
  return FalseLoopKind::random;
}

void print_row(const std::string& graph, const MeasurementLog& log, const std::vector<Pose>& clean,
               const BackEnd& back_end, const std::vector<Pose>& own_clean, double share,
               const std::string& kind, int seeds) {
  std::vector<double> errors;
  std::size_t kept = 0;
  std::size_t lost = 0;
  std::size_t false_loops = 0;
  double ms = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    SpoilOptions options;
    options.share = share;
    options.kind = kind_of(kind);
    const Spoiled spoiled = spoil(log, clean, options, static_cast<std::uint64_t>(seed));
    const Solved solved = solve(spoiled.log, back_end);
    errors.push_back(mean_distance_m(solved.poses, own_clean));
    ms += solved.ms / seeds;
    for (std::size_t j = 0; j < spoiled.is_false.size(); ++j) {
      if (spoiled.is_false[j]) ++false_loops;
      if (spoiled.is_false[j] && solved.weights[j] > 0.5) ++kept;
      if (!spoiled.is_false[j] && solved.weights[j] <= 0.5) ++lost;
    }
  }
  std::sort(errors.begin(), errors.end());
  std::printf("| %s | %.0f %% | %s | %s | %.4f | %.4f | %zu of %zu | %zu of %zu | %.0f |\n",
              graph.c_str(), 100.0 * share, kind.c_str(), back_end.name.c_str(),
              errors[errors.size() / 2], errors.back(), kept, false_loops, lost,
              log.registration_count() * static_cast<std::size_t>(seeds), ms);
  std::fflush(stdout);
}

void run(const Flags& flags) {
  std::printf(
      "| graph | false | kind | back end | median error m | worst | false kept | right lost | ms "
      "|\n|---|---|---|---|---|---|---|---|---|\n");
  for (const std::string& path : flags.graphs) {
    const MeasurementLog log = read_g2o(path);
    const std::string name = std::filesystem::path(path).stem().string();
    const std::vector<Pose> clean = solve(log, back_ends().front()).poses;
    for (const BackEnd& back_end : back_ends()) {
      if (std::find(flags.back_ends.begin(), flags.back_ends.end(), back_end.name) ==
          flags.back_ends.end()) {
        continue;
      }
      const std::vector<Pose> own_clean = solve(log, back_end).poses;
      for (const double share : flags.shares) {
        for (const std::string& kind : flags.kinds) {
          print_row(name, log, clean, back_end, own_clean, share, kind, flags.seeds);
        }
      }
    }
  }
}

}  // namespace
}  // namespace fathom

int main(int argc, char** argv) {
  CLI::App app("Back ends on graphs with false loops");
  fathom::Flags flags;
  app.add_option("--seeds", flags.seeds);
  app.add_option("--shares", flags.shares)->delimiter(',')->allow_extra_args(false);
  app.add_option("--kinds", flags.kinds)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"random", "local", "grouped"}));
  app.add_option("--back-ends", flags.back_ends)->delimiter(',')->allow_extra_args(false);
  app.add_option("graphs", flags.graphs)->required();
  try {
    app.parse(argc, argv);
    fathom::run(flags);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
