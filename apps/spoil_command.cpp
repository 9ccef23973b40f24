// fathom spoil: a pose graph with false loops, to try back ends on.

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "fathom/core/files.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/false_loops.hpp"
#include "fathom/measurements/g2o.hpp"

namespace fathom {
namespace {

struct SpoilFlags {
  std::string graph;
  std::string out;
  std::string ground_truth;
  std::string kind = "random";
  SpoilOptions options{.share = 0.3};
  int seed = 1;
  bool quiet = false;
};

void set_kind(const std::string& name, SpoilOptions& options) {
  OptionTable table;
  options.describe(table);
  table.set("kind", OptionValue::scalar(name));
}

void spoil_graph(const SpoilFlags& flags, const CLI::App& command, Context& context) {
  SpoilOptions options = flags.options;
  set_kind(flags.kind, options);
  // The range that CLI11 checks lets NaN through.
  if (!std::isfinite(options.share)) throw InputError("--share: expected a number");
  if (command.count("--group-size") > 0 && options.kind != FalseLoopKind::grouped) {
    throw InputError("--group-size: only --kind grouped has groups");
  }
  if (command.count("--reach") > 0 && options.kind != FalseLoopKind::local) {
    throw InputError("--reach: only --kind local has one");
  }
  Recording recording = record_graph(flags.graph);
  if (options.share > 0.0 && recording.log.registration_count() == 0) {
    throw InputError(flags.graph,
                     "has no loop whose motion and information a false one could take");
  }
  if (!flags.ground_truth.empty()) attach_ground_truth(recording, flags.ground_truth);
  const std::vector<Pose> reference = reference_poses(recording, builtin_estimators());
  const Spoiled spoiled =
      spoil(recording.log, reference, options, static_cast<std::uint64_t>(flags.seed));
  const std::string list =
      std::filesystem::path(flags.out).replace_extension(".false_loops.csv").string();
  write_file(flags.out, to_g2o(spoiled.log));
  write_file(list, false_loops_csv(spoiled));
  context.status = kDone;
  if (flags.quiet) return;
  const std::size_t all = spoiled.log.registration_count();
  std::printf("%zu false loops, %s, among %zu\nwrote %s\n      %s\n",
              all - recording.log.registration_count(), name_of(options.kind).c_str(), all,
              flags.out.c_str(), list.c_str());
}

}  // namespace

void add_spoil(CLI::App& app, Context& context) {
  auto flags = std::make_shared<SpoilFlags>();
  CLI::App* command = app.add_subcommand("spoil", "Add false loops to a pose graph");
  command->footer(
      "Example: fathom spoil intel.g2o --share 0.3 --kind grouped --out spoilt.g2o\n"
      "         fathom solve spoilt.g2o --estimator sparse_gauss_newton --set "
      "estimator.loss=truncated --false-loops spoilt.false_loops.csv");
  command->add_option("graph", flags->graph, "Pose graph (g2o)")->required();
  command->add_option("--share", flags->options.share, "False loops as a share of all loops")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  command
      ->add_option("--kind", flags->kind,
                   "random: between any two poses; local: near ones; grouped: in groups that agree")
      ->check(CLI::IsMember({"random", "local", "grouped"}))
      ->type_name("KIND")
      ->capture_default_str();
  command->add_option("--group-size", flags->options.group_size, "grouped: loops of a group")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--reach", flags->options.reach, "local: the poses are at most so far apart")
      ->check(CLI::Range(2, 1000000))
      ->capture_default_str();
  command
      ->add_option("--ground-truth", flags->ground_truth,
                   "True poses (TUM, vertex ids as time stamps); else the optimum of the graph "
                   "says which loops are false")
      ->type_name("FILE");
  command->add_option("--seed", flags->seed, "Another seed, other loops")
      ->check(CLI::NonNegativeNumber)
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--out", flags->out, "Graph to write (g2o); the list lies beside it")
      ->required()
      ->type_name("FILE");
  command->add_flag("--quiet", flags->quiet, "No output but errors");
  command->callback([flags, command, &context] { spoil_graph(*flags, *command, context); });
}

}  // namespace fathom
