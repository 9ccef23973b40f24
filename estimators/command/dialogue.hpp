#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "estimators/command/program_graph.hpp"
#include "fathom/core/program.hpp"

namespace fathom::command {

/// A program that runs as long as the log does and is told of every node and edge by lines, as the
/// interactive programs of the automated SLAM evaluation of 2011 are:
///
///     ADD VERTEX_XYT id x y θ;
///     ADD EDGE_XYT edge from to x y θ Ω11 Ω12 Ω13 Ω22 Ω23 Ω33;
///     FIX 0;
///     SOLVE_STATE;
///     QUERY_STATE;
///
/// The last is answered by BEGIN, a line `VERTEX_XYT id x y θ` for each node, END. What is printed
/// outside of an answer is ignored.
class Dialogue {
 public:
  Dialogue(std::vector<std::string> words, int solves)
      : words_(std::move(words)), solves_(solves) {}

  /// The poses of all nodes, after the program was told what of the graph it does not know. Throws
  /// ProgramFailure where it ends, std::runtime_error where its answer is none.
  std::vector<Pose> solve(const ProgramGraph& graph);

 private:
  void begin(const ProgramGraph& graph);

  std::vector<std::string> words_;
  int solves_;
  std::unique_ptr<Program> program_;
  std::size_t nodes_ = 0;  ///< told so far
  std::size_t edges_ = 0;
};

/// The poses of `count` nodes that a program answers with: what follows BEGIN, up to END.
/// `next_line` throws where there is none. Throws std::runtime_error where a line is no pose of a
/// node, or a node has none or two.
std::vector<Pose> answered_poses(const std::function<std::string()>& next_line, std::size_t count);

}  // namespace fathom::command
