#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimators/command/program_graph.hpp"
#include "fathom/core/work_folder.hpp"

namespace fathom::command {

/// A program that is called with two files, and ends: it reads a g2o file and writes the poses to
/// another, as g2o or as TUM, one for every node.
class SolverFiles {
 public:
  /// Words of the command; `{input}` and `{output}` in them stand for the files.
  explicit SolverFiles(std::vector<std::string> words) : words_(std::move(words)) {}

  /// The poses of all nodes as the program has them. Throws ProgramFailure where it does not end
  /// well, std::runtime_error where what it wrote is no such file, EnvironmentError where the
  /// folder of temporary files is not there, or has no room for these.
  std::vector<Pose> solve(const ProgramGraph& graph);

 private:
  std::vector<Pose> call(const ProgramGraph& graph, double& processor_s, std::int64_t& peak_bytes);
  void measure_start_up(const ProgramGraph& graph);

  std::vector<std::string> words_;
  std::optional<WorkFolder> folder_;
  std::optional<double> start_up_s_;
};

/// The graph as g2o text: VERTEX_SE2, FIX 0, EDGE_SE2.
std::string to_text(const ProgramGraph& graph);

/// The poses of `count` nodes in a text, g2o (VERTEX_SE2, each once, in any order, other lines
/// ignored) or TUM (in the order of the nodes, with times that rise). Throws std::runtime_error.
std::vector<Pose> poses_in(const std::string& text, std::size_t count);

}  // namespace fathom::command
