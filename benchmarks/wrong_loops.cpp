// How back ends stand false loops: graphs with a share of false ones added, each solved as a batch
// and compared with one reference for all, the least-squares optimum of the same graph without
// them. A share of 0 tells what a back end makes of the clean graph. Prints a Markdown table.
//
// False loops of one draw share their fate, so the column `draws` counts independent trials: those
// in which a false loop is kept. `errors m` has the error of every draw, least first.
//
//   wrong_loops [--seeds N] [--shares 0,0.1,0.3,0.5] [--kinds random,local,grouped]
//               [--back-ends NAME,…] GRAPH.g2o …

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "fathom/core/pin_threads.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/false_loops.hpp"
#include "fathom/harness/replay.hpp"

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
  std::vector<double> shares{0.0, 0.1, 0.3, 0.5};
  std::vector<std::string> kinds{"random", "local", "grouped"};
  std::vector<std::string> back_ends{"plain",         "huber", "cauchy",   "dcs",
                                     "geman_mcclure", "gnc",   "truncated"};
  std::vector<std::string> graphs;
};

Run solve(const MeasurementLog& log, const BackEnd& back_end) {
  EstimatorValues values;
  for (const auto& [key, value] : back_end.options) values[key] = OptionValue::scalar(value);
  ReplayOptions options;
  options.mode = SolveMode::batch;
  options.covariances = false;
  return replay(log, builtin_estimators().find(back_end.type), values, options);
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

// What is the same for all seeds.
struct Case {
  std::string graph;
  const MeasurementLog& log;
  const std::vector<Pose>& optimum;
  double share = 0.0;
  std::string kind;
};

std::string listed(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.4f", text.empty() ? "" : " ", value);
    text += number;
  }
  return text;
}

void print_row(const Case& one, const BackEnd& back_end, int seeds) {
  std::vector<double> errors;
  std::size_t false_loops = 0;
  std::size_t kept = 0;
  std::size_t lost = 0;
  int draws_with_kept = 0;
  double cpu_ms = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    SpoilOptions options;
    options.share = one.share;
    options.kind = kind_of(one.kind);
    const Spoiled spoiled = spoil(one.log, one.optimum, options, static_cast<std::uint64_t>(seed));
    const Run solved = solve(spoiled.log, back_end);
    errors.push_back(mean_distance_m(solved.trajectory, one.optimum));
    cpu_ms += solved.costs.cpu_ms / seeds;
    const std::size_t kept_so_far = kept;
    for (std::size_t j = 0; j < spoiled.is_false.size(); ++j) {
      const bool is_kept = solved.loop_weights[j] > 0.5;
      if (spoiled.is_false[j]) ++false_loops;
      if (spoiled.is_false[j] && is_kept) ++kept;
      if (!spoiled.is_false[j] && !is_kept) ++lost;
    }
    if (kept > kept_so_far) ++draws_with_kept;
  }
  std::sort(errors.begin(), errors.end());
  std::printf(
      "| %s | %.0f %% | %s | %s | %.4f | %.4f | %zu of %zu | %zu of %zu | %d of %d | %s | %.0f |\n",
      one.graph.c_str(), 100.0 * one.share, one.kind.c_str(), back_end.name.c_str(),
      errors[errors.size() / 2], errors.back(), kept, false_loops, lost,
      one.log.registration_count() * static_cast<std::size_t>(seeds), draws_with_kept, seeds,
      listed(errors).c_str(), cpu_ms);
  std::fflush(stdout);
}

// Without false loops kinds and seeds are all the same.
void print_rows(const std::string& graph, const Recording& recording,
                const std::vector<Pose>& optimum, const BackEnd& back_end, const Flags& flags) {
  for (const double share : flags.shares) {
    if (share == 0.0) {
      print_row({graph, recording.log, optimum, share, "none"}, back_end, 1);
      continue;
    }
    for (const std::string& kind : flags.kinds) {
      print_row({graph, recording.log, optimum, share, kind}, back_end, flags.seeds);
    }
  }
}

void run(const Flags& flags) {
  std::printf(
      "| graph | false | kind | back end | median error m | worst | false kept | right lost | "
      "draws "
      "| errors m | CPU ms |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const std::string& path : flags.graphs) {
    const Recording recording = record_graph(path);
    const std::vector<Pose> optimum = reference_poses(recording, builtin_estimators());
    for (const BackEnd& back_end : back_ends()) {
      if (std::find(flags.back_ends.begin(), flags.back_ends.end(), back_end.name) ==
          flags.back_ends.end()) {
        continue;
      }
      print_rows(std::filesystem::path(path).stem().string(), recording, optimum, back_end, flags);
    }
  }
}

}  // namespace
}  // namespace fathom

int main(int argc, char** argv) try {
  fathom::pin_threads();
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
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  }
  fathom::run(flags);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
