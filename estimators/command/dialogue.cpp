#include "estimators/command/dialogue.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "fathom/core/text.hpp"

namespace fathom::command {
namespace {

std::string vertex_text(std::size_t node, const Pose& pose) {
  return "ADD VERTEX_XYT " + std::to_string(node) + text_of(pose) + ";\n";
}

}  // namespace

// It can begin when it has answered for the first time.
void Dialogue::begin(const ProgramGraph& graph) {
  program_ = std::make_unique<Program>(words_);
  program_->send(vertex_text(0, graph.poses[0]) + "FIX 0;\nQUERY_STATE 0;\n");
  nodes_ = 1;
  while (trim(program_->next_line()) != "END") {
  }
}

std::vector<Pose> answered_poses(const std::function<std::string()>& next_line, std::size_t count) {
  while (trim(next_line()) != "BEGIN") {
  }
  std::vector<Pose> poses(count);
  std::vector<bool> is_there(count, false);
  for (;;) {
    const std::string line = next_line();
    const auto words = split(line);
    if (words.size() == 1 && words[0] == "END") break;
    const auto id = words.size() == 5 ? parse_integer(words[1]) : std::nullopt;
    const bool is_vertex = words.size() == 5 && words[0] == "VERTEX_XYT" && id && *id >= 0 &&
                           static_cast<std::size_t>(*id) < count && parse_real(words[2]) &&
                           parse_real(words[3]) && parse_real(words[4]);
    if (!is_vertex) {
      throw std::runtime_error("expected 'VERTEX_XYT id x y theta' of a node, got " +
                               in_quotes(line.substr(0, 80)));
    }
    const auto node = static_cast<std::size_t>(*id);
    if (is_there[node]) {
      throw std::runtime_error("the answer has vertex " + std::to_string(node) + " twice");
    }
    poses[node] = {*parse_real(words[2]), *parse_real(words[3]), *parse_real(words[4])};
    is_there[node] = true;
  }
  const auto missing = std::ranges::find(is_there, false);
  if (missing == is_there.end()) return poses;
  throw std::runtime_error("the answer has no vertex " +
                           std::to_string(missing - is_there.begin()));
}

std::vector<Pose> Dialogue::solve(const ProgramGraph& graph) {
  ForProgram work;
  if (!program_) {
    begin(graph);
    work.add_start_up_s(program_->processor_s());
  }
  const double before_s = program_->processor_s();
  std::string text;
  for (std::size_t k = nodes_; k < graph.poses.size(); ++k) {
    text += vertex_text(k, graph.poses[k]);
  }
  for (std::size_t j = edges_; j < graph.edges.size(); ++j) {
    text += "ADD EDGE_XYT " + std::to_string(j) + text_of(graph.edges[j]) + ";\n";
  }
  nodes_ = graph.poses.size();
  edges_ = graph.edges.size();
  for (int i = 0; i < solves_; ++i) text += "SOLVE_STATE;\n";
  program_->send(text + "QUERY_STATE;\n");
  std::vector<Pose> poses =
      answered_poses([this] { return program_->next_line(); }, graph.poses.size());
  work.add_processor_s(program_->processor_s() - before_s);
  work.note_peak(program_->peak_bytes());
  return poses;
}

}  // namespace fathom::command
