// fathom solve: a pose graph from a g2o file.

#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "apps/terminal.hpp"
#include "fathom/core/text.hpp"
#include "fathom/report/table.hpp"
#include "fathom/workflow/result_table.hpp"
#include "fathom/workflow/solve.hpp"

namespace fathom {
namespace {

struct SolveFlags {
  CommonFlags common;
  std::string graph;
  std::string estimator;
  std::string mode;
  std::string init = "odometry";
  std::string ground_truth;
  std::string false_loops;
  std::optional<int> component;
  bool drop_self_edges = false;
};

std::string chi2_text(const Result& result, const char* metric) {
  constexpr int kDigits = 10;
  return format_number(result.metric(metric), kDigits);
}

std::string also_text(const MeasurementLog& log) {
  std::string text;
  if (log.absolute_count() > 0)
    text += ", " + counted(log.absolute_count(), "absolute measurement");
  if (log.hole_count() > 0) text += ", " + counted(log.hole_count(), "hole");
  if (log.start().is_free) return text + ", free start";
  return log.start().is_fixed() ? text : text + ", uncertain start";
}

void print_solved(const SolveFlags& flags, const Recording& recording, const Result& result) {
  const MeasurementLog& log = recording.log;
  print("%s: %zu poses, %zu edges, %zu of them loop closures%s\n", flags.graph.c_str(), log.size(),
        log.size() - 1 - log.hole_count() + log.registration_count(), log.registration_count(),
        also_text(log).c_str());
  print("%s, %s: %s after %d iterations\n", result.estimator.type.c_str(),
        result.mode == SolveMode::batch ? "batch" : "incremental",
        name_of(result.run.outcome).c_str(), result.run.iterations);
  print("chi2 %s, from %s at the start\n", chi2_text(result, "chi2").c_str(),
        chi2_text(result, "chi2_initial").c_str());
  if (result.run.gradient_norm) {
    print("gradient %.2g", *result.run.gradient_norm);
    if (result.run.is_local_minimum) {
      print(", %s", *result.run.is_local_minimum ? "a local minimum" : "no local minimum");
    }
    print("\n");
  }
  if (const auto given = result.metric("absolute_measurements")) {
    print("absolute measurements: %.0f of %.0f used, %.0f rejected, %.0f lost, chi2 %s\n",
          result.metrics.at("absolute_used"), *given, result.metrics.at("absolute_rejected"),
          result.metrics.at("absolute_lost"), chi2_text(result, "absolute_chi2").c_str());
  }
  if (const auto false_loops = result.metric("false_loops")) {
    print("%.0f of %.0f false loops kept, %.0f right ones lost\n",
          result.metrics.at("false_loops_kept"), *false_loops,
          result.metrics.at("right_loops_lost"));
  }
  print("\n");
  print("%s", workflow::result_table(recording, {result}).c_str());
}

void solve(const SolveFlags& flags, Context& context) {
  workflow::SolveGraphRequest request;
  request.graph = flags.graph;
  request.settings = flags.common.settings("");
  request.estimator = flags.estimator;
  request.mode = flags.mode;
  request.starts_from_file = flags.init == "file";
  request.ground_truth = flags.ground_truth;
  request.false_loops = flags.false_loops;
  request.component = flags.component;
  request.drop_self_edges = flags.drop_self_edges;
  request.out = flags.common.out;
  request.made_by = context.command_line;
  Terminal terminal(flags.common.quiet);
  const workflow::SolveOutcome done =
      workflow::solve_graph(request, flags.common.estimators(), this_program(), terminal);
  terminal.clear();
  context.status = done.result.is_done() ? kDone : kFailed;
  if (flags.common.quiet) return;
  print_solved(flags, done.recording, done.result);
  print("\n");
  terminal.print_written();
  terminal.print_remarks();
}

}  // namespace

void add_solve(CLI::App& program, Context& context) {
  auto flags = std::make_shared<SolveFlags>();
  Command command(program, "solve", "Solve a pose graph",
                  "Example: fathom solve intel.g2o --estimator ceres_pose_graph --mode batch\n"
                  "         fathom solve ring.g2o --estimator trajectory_iekf --set "
                  "estimator.max_iterations=3");
  command.argument("graph", flags->graph, "Pose graph (g2o)");
  command.text("--estimator", flags->estimator, "ESTIMATOR",
               "Estimator (default: ceres_pose_graph)");
  command.choice("--mode", flags->mode, {"incremental", "batch"}, "MODE",
                 "incremental: keyframe by keyframe; batch: one solve (default where it can)");
  command.choice("--init", flags->init, {"odometry", "file"}, "START",
                 "Where a batch solve starts: odometry or file");
  command.text("--ground-truth", flags->ground_truth, "FILE",
               "True poses (TUM, vertex ids as time stamps), to judge by");
  command.text("--false-loops", flags->false_loops, "FILE",
               "Which loops are false, as 'spoil' wrote it, to judge by");
  command.integer("--component", flags->component, Range::at_least(1), "K",
                  "Of a graph that falls into several, this one ('check' lists them)");
  add_drop_self_edges_to(command, flags->drop_self_edges);
  flags->common.add_settings_to(command, context);
  flags->common.add_out_to(command, "Output folder (default: runs/GRAPH-ESTIMATOR)");
  command.on_run([flags, &context] { solve(*flags, context); });
}

}  // namespace fathom
