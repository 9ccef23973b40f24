#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fathom/measurements/measurement_log.hpp"

namespace fathom::benchmarks {

/// What the order of elimination says of a map: bounds of what a solve takes.
struct MapBound {
  std::size_t keyframes = 0;
  std::size_t loops = 0;
  int separator = 0;           ///< unknowns of the largest dense triangle of the factor
  double multiply_adds = 0.0;  ///< of one factorisation
  double factor_mib = 0.0;     ///< of the factor's numbers
};

/// One batch solve from dead reckoning, in a process of its own.
struct MapSolve {
  double seconds = 0.0;  ///< wall time, the keyframes handed over before
  double cpu_s = 0.0;    ///< processor time of all threads in it
  double mib = 0.0;      ///< peak memory of the process, the log in it
  double chi2 = 0.0;
  std::string outcome;
};

/// Who solves, and on how many threads.
struct MapSolver {
  std::string estimator;
  int threads = 1;

  /// As a table has it.
  std::string name() const;
};

/// A map of one shape and size; a solve is absent where it took longer than the limit.
struct MapCost {
  std::string shape;
  MapBound bound;
  std::vector<std::optional<MapSolve>> solves;  ///< by solver
};

struct MapSettings {
  std::vector<std::size_t> keyframes{1000, 3000, 10000, 30000, 100000, 300000, 1000000};
  std::vector<MapSolver> solvers{
      {"sparse_gauss_newton", 1}, {"sparse_gauss_newton", 2}, {"ceres_pose_graph", 1}};
  double limit_s = 300.0;  ///< of a process; what was slower for a smaller map is not tried
  int repeats = 3;         ///< of which the fastest counts; one where a solve takes 10 s
  std::string program;     ///< this one
};

inline const std::vector<std::string> kShapes{"survey", "city"};

/// A map by its shape, with a loop for about every third keyframe.
MeasurementLog map_of(const std::string& shape, std::size_t keyframes);

MapBound bound_of(const MeasurementLog& log);

/// One solve in this process, as a line that parse_solve reads.
std::string solve_here(const std::string& shape, std::size_t keyframes, const MapSolver& solver);
std::optional<MapSolve> parse_solve(const std::string& line);

std::vector<MapCost> measure_maps(const MapSettings& settings);

/// A table a shape, as Markdown; and wall time against keyframes, an SVG file.
std::string markdown(const std::vector<MapCost>& costs, const std::vector<MapSolver>& solvers);
std::string chart(const std::vector<MapCost>& costs, const std::vector<MapSolver>& solvers);

}  // namespace fathom::benchmarks
