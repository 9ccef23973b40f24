#include "maps.hpp"

#include <chrono>
#include <cstdio>
#include <sstream>

#include "city.hpp"
#include "estimators/support/pose_graph/normal_equations.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/system.hpp"
#include "fathom/core/workers.hpp"
#include "fathom/estimators/builtin.hpp"
#include "survey.hpp"

namespace fathom::benchmarks {
namespace {

constexpr double kSlowS = 10.0;
constexpr double kBlockMib = 9.0 * sizeof(double) / (1 << 20);

// Block columns of the largest triangle that pieces of one supernode make together.
int largest_triangle(const sparse::Symbolic& symbolic) {
  int largest = 0;
  int width = 0;
  int rows_left = -1;
  for (const sparse::Supernode& s : symbolic.supernodes) {
    width = s.panel_rows() == rows_left ? width + s.width : s.width;
    rows_left = s.height;
    largest = std::max(largest, width);
  }
  return largest;
}

std::optional<MapSolve> solve_apart(const MapSettings& settings, const std::string& shape,
                                    std::size_t keyframes, const MapSolver& solver) {
  std::ostringstream command;
  command << "timeout " << settings.limit_s << " '" << settings.program << "' --solve " << shape
          << " --keyframes " << keyframes << " --estimators " << solver.estimator << " --threads "
          << solver.threads;
  FILE* const pipe = popen(command.str().c_str(), "r");
  if (pipe == nullptr) throw InputError(settings.program + ": cannot be started");
  char line[256] = {};
  const bool has_line = std::fgets(line, sizeof line, pipe) != nullptr;
  pclose(pipe);
  return has_line ? parse_solve(line) : std::nullopt;
}

// The fastest of several solves by each, taken in turns; nothing of one that is hopeless.
std::vector<std::optional<MapSolve>> fastest_solves(const MapSettings& settings,
                                                    const std::string& shape, std::size_t keyframes,
                                                    const std::vector<char>& is_hopeless) {
  std::vector<std::optional<MapSolve>> fastest(settings.solvers.size());
  for (int round = 0; round < settings.repeats; ++round) {
    for (std::size_t i = 0; i < fastest.size(); ++i) {
      const bool is_due = round == 0 || (fastest[i] && fastest[i]->seconds < kSlowS);
      if (is_hopeless[i] != 0 || !is_due) continue;
      const auto solve = solve_apart(settings, shape, keyframes, settings.solvers[i]);
      if (!solve) continue;
      if (!fastest[i] || solve->seconds < fastest[i]->seconds) fastest[i] = solve;
    }
  }
  return fastest;
}

}  // namespace

std::string MapSolver::name() const {
  return "`" + estimator + "`" + (threads > 1 ? ", " + std::to_string(threads) + " threads" : "");
}

MeasurementLog map_of(const std::string& shape, std::size_t keyframes) {
  if (shape == "survey") return parallel_tracks(keyframes, keyframes / 3);
  if (shape == "city") return city_streets(keyframes);
  throw InputError("no map has the shape '" + shape + "'; use survey or city");
}

MapBound bound_of(const MeasurementLog& log) {
  std::vector<pose_graph::Edge> edges;
  for (std::size_t k = 1; k < log.size(); ++k) {
    edges.push_back(pose_graph::make_edge(log.arrival(k).step));
    for (const RelativePose& z : log.arrival(k).registrations) {
      edges.push_back(pose_graph::make_edge(z));
    }
  }
  const sparse::Symbolic symbolic = pose_graph::analyse_graph(edges, static_cast<int>(log.size()));
  return {log.size(), log.registration_count(), 3 * largest_triangle(symbolic),
          27.0 * multiplications_of(symbolic),
          kBlockMib * static_cast<double>(symbolic.panel_blocks)};
}

std::string solve_here(const std::string& shape, std::size_t keyframes, const MapSolver& solver) {
  using Clock = std::chrono::steady_clock;
  const MeasurementLog log = map_of(shape, keyframes);
  const EstimatorRegistry& registry = builtin_estimators();
  EstimatorValues values;
  if (solver.threads > 1) values["threads"] = OptionValue::scalar(std::to_string(solver.threads));
  const auto estimator =
      registry.find(solver.estimator).create({log.origin(), SolveMode::batch}, values);
  for (std::size_t k = 1; k < log.size(); ++k) {
    estimator->add_keyframe(log.arrival(k).step);
    if (log.arrival(k).registrations.empty()) continue;
    estimator->update({log.arrival(k).registrations});
  }
  const double cpu_start_s = thread_processor_seconds();
  const auto start = Clock::now();
  const UpdateReport report = estimator->finish({});
  const std::chrono::duration<double> elapsed = Clock::now() - start;
  const double cpu_s = thread_processor_seconds() - cpu_start_s;
  const double mib = peak_memory_mib();
  char line[256];
  std::snprintf(line, sizeof line, "%.6g %.6g %.6g %.17g %s\n", elapsed.count(), cpu_s, mib,
                chi2(log, poses_of(*estimator)), name_of(report.outcome).c_str());
  return line;
}

std::optional<MapSolve> parse_solve(const std::string& line) {
  std::istringstream words(line);
  MapSolve solve;
  if (words >> solve.seconds >> solve.cpu_s >> solve.mib >> solve.chi2 >> solve.outcome)
    return solve;
  return std::nullopt;
}

std::vector<MapCost> measure_maps(const MapSettings& settings) {
  std::vector<MapCost> costs;
  for (const std::string& shape : kShapes) {
    std::vector<char> is_hopeless(settings.solvers.size(), 0);
    for (const std::size_t keyframes : settings.keyframes) {
      // The log is gone before a solve starts: a million keyframes fill the memory of a machine.
      MapCost cost{shape, bound_of(map_of(shape, keyframes)), {}};
      cost.solves = fastest_solves(settings, shape, keyframes, is_hopeless);
      for (std::size_t i = 0; i < is_hopeless.size(); ++i) is_hopeless[i] = cost.solves[i] ? 0 : 1;
      costs.push_back(std::move(cost));
      std::fprintf(stderr, "%s, %zu keyframes: done\n", shape.c_str(), keyframes);
    }
  }
  return costs;
}

}  // namespace fathom::benchmarks
