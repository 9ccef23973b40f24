#include "estimators/command/command.hpp"

#include <algorithm>
#include <stdexcept>

#include "estimators/command/dialogue.hpp"
#include "estimators/command/solver_files.hpp"
#include "fathom/core/program.hpp"

namespace fathom {
namespace {

bool names(const std::string& command, const char* file) {
  return command.find(file) != std::string::npos;
}

bool is_by_files(const std::string& command) {
  return names(command, "{input}") && names(command, "{output}");
}

}  // namespace

namespace command {

// By files or by lines, as the command has it.
class Solver {
 public:
  explicit Solver(const CommandOptions& options) {
    std::vector<std::string> words = words_of_command(options.command);
    if (is_by_files(options.command)) {
      files_ = std::make_unique<SolverFiles>(std::move(words));
    } else {
      dialogue_ = std::make_unique<Dialogue>(std::move(words), options.solves);
    }
  }

  std::vector<Pose> solve(const ProgramGraph& graph) {
    return files_ ? files_->solve(graph) : dialogue_->solve(graph);
  }

 private:
  std::unique_ptr<SolverFiles> files_;
  std::unique_ptr<Dialogue> dialogue_;
};

}  // namespace command

void CommandOptions::describe(OptionTable& table) {
  table.text("command", command,
             "the program and its arguments; with {input} and {output} it is called with files, "
             "without it is spoken to by lines");
  table.integer("solves", solves, Range::between(1, 1000), "",
                "by lines: SOLVE_STATE so often after each keyframe with measurements");
  table.integer("max_iterations", max_iterations, Range::at_least(1), "",
                "of no effect: the program has options of its own");
  table.real("tolerance", tolerance, Range::positive(), "", "of no effect");
  gate.describe(table);
}

void CommandOptions::check(const EstimatorSetup&) const {
  const std::vector<std::string> words = words_of_command(command);
  if (words.empty()) {
    throw InputError(
        "command: there is none; expected a program, such as 'solver {input} {output}'");
  }
  if (names(command, "{input}") != names(command, "{output}")) {
    throw InputError("command: it has one of {input} and {output}; expected both, or none");
  }
  try {
    find_program(words.front());
  } catch (const InputError& error) {
    throw InputError(std::string("command: ") + error.what());
  }
  if (gate.probability) {
    throw InputError("gate_probability: the program has no innovations to gate; use off");
  }
}

CommandEstimator::CommandEstimator(const EstimatorSetup& setup, const CommandOptions& options)
    : mode_(setup.mode),
      solver_(std::make_unique<command::Solver>(options)),
      graph_{{setup.start.pose}, {}} {}

CommandEstimator::~CommandEstimator() = default;

void CommandEstimator::add_keyframe(const RelativePose& step) {
  const RelativePose forward = step.forward();
  graph_.poses.push_back(compose(graph_.poses.back(), forward.motion));
  if (mode_ == SolveMode::incremental || !step.is_hole) graph_.edges.push_back(step);
}

// Where node 0 has another place in the answer, all of it is moved.
void CommandEstimator::solve() {
  const std::vector<Pose> answer = solver_->solve(graph_);
  if (!std::ranges::all_of(answer, is_finite)) {
    throw std::runtime_error("the program's poses are not finite");
  }
  const Pose& start = graph_.poses[0];
  const bool is_in_place = answer[0] == start;
  for (std::size_t k = 1; k < answer.size(); ++k) {
    const Pose as_said{answer[k].x, answer[k].y, wrap_angle(answer[k].theta)};
    graph_.poses[k] = is_in_place ? as_said : compose(start, between(answer[0], as_said));
  }
}

UpdateReport CommandEstimator::close_loops(std::span<const RelativePose> loops) {
  UpdateReport report;
  for (const RelativePose& z : loops) {
    graph_.edges.push_back(z);
    report.loops.push_back({z.from, z.to, LoopFate::used, std::nullopt});
  }
  if (mode_ == SolveMode::incremental) solve();
  return report;
}

UpdateReport CommandEstimator::finish(std::span<const Pose> start) {
  if (mode_ == SolveMode::incremental) return {};
  if (!start.empty()) graph_.poses.assign(start.begin(), start.end());
  if (graph_.edges.empty()) return {};
  solve();
  return {};
}

EstimatorEntry command_entry() {
  EstimatorEntry entry = make_relative_entry<CommandOptions>(
      "command", "another program, called with files or spoken to by lines", true,
      [](const EstimatorSetup& setup, const CommandOptions& options) {
        return std::make_unique<CommandEstimator>(setup, options);
      });
  entry.unused_options = {"max_iterations", "tolerance"};
  entry.runs_program = true;
  return entry;
}

}  // namespace fathom
