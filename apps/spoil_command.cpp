// fathom spoil: a pose graph with false loops, to try back ends on.

#include <filesystem>
#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "fathom/core/files.hpp"
#include "fathom/harness/false_loops.hpp"
#include "fathom/measurements/shared_file.hpp"

namespace fathom {
namespace {

struct SpoilFlags {
  std::string graph;
  std::string out;
  std::string ground_truth;
  std::string kind = "random";
  SpoilOptions options{.share = 0.3};
  int seed = 1;
  GraphOptions reading;
};

void set_kind(const std::string& name, SpoilOptions& options) {
  OptionTable table;
  options.describe(table);
  table.set("kind", OptionValue::scalar(name));
}

void refuse_unused(const SpoilFlags& flags, const Flag& group_size, const Flag& reach) {
  if (group_size.is_given() && flags.kind != "grouped") {
    throw InputError("--group-size: only --kind grouped has groups");
  }
  if (reach.is_given() && flags.kind != "local") {
    throw InputError("--reach: only --kind local has one");
  }
}

void spoil_graph(const SpoilFlags& flags, Context& context) {
  SpoilOptions options = flags.options;
  set_kind(flags.kind, options);
  const std::string list =
      std::filesystem::path(flags.out).replace_extension(".false_loops.csv").string();
  for (const std::string& output : {flags.out, list}) {
    refuse_replacing(output_file(output), {flags.graph, flags.ground_truth});
  }
  Recording recording = record_graph(flags.graph, flags.reading);
  if (options.share > 0.0 && recording.log.registration_count() == 0) {
    throw InputError(flags.graph,
                     "has no loop whose motion and information a false one could take");
  }
  if (!flags.ground_truth.empty()) attach_ground_truth(recording, flags.ground_truth);
  const std::vector<Pose> reference = reference_poses(recording, context.estimators().registry());
  const Spoiled spoiled =
      spoil(recording.log, reference, options, static_cast<std::uint64_t>(flags.seed));
  // A start of the file's own is a start of the spoilt one, too.
  write_graph(output_file(flags.out), spoiled.log, spoiled.log.guess);
  write_file(output_file(list), false_loops_csv(spoiled));
  context.status = kDone;
  const std::size_t all = spoiled.log.registration_count();
  print("%zu false loops, %s, among %zu\nwrote %s\n      %s\n",
        all - recording.log.registration_count(), name_of(options.kind).c_str(), all,
        flags.out.c_str(), list.c_str());
}

}  // namespace

void add_spoil(CLI::App& program, Context& context) {
  auto flags = std::make_shared<SpoilFlags>();
  Command command(program, "spoil", "Add false loops to a pose graph",
                  "Example: fathom spoil intel.g2o --share 0.3 --kind grouped --out spoilt.g2o\n"
                  "         fathom solve spoilt.g2o --estimator sparse_gauss_newton --set "
                  "estimator.loss=truncated --false-loops spoilt.false_loops.csv");
  command.argument("graph", flags->graph, "Pose graph (g2o)");
  command.real("--share", flags->options.share, Range::between(0.0, 0.9), "SHARE",
               "False loops as a share of all loops");
  command.choice("--kind", flags->kind, {"random", "local", "grouped"}, "KIND",
                 "random: between any two poses; local: near ones; grouped: in groups that agree");
  const Flag group_size =
      command.integer("--group-size", flags->options.group_size, Range::between(1, 1000), "N",
                      "grouped: loops of a group");
  const Flag reach = command.integer("--reach", flags->options.reach, Range::between(2, 1000000),
                                     "N", "local: the poses are at most so far apart");
  command.text("--ground-truth", flags->ground_truth, "FILE",
               "True poses (TUM, vertex ids as time stamps); else the optimum of the graph "
               "says which loops are false");
  add_drop_self_edges_to(command, flags->reading.drop_self_edges);
  command.integer("--seed", flags->seed, Range::at_least(0), "N", "Another seed, other loops");
  command.text("--out", flags->out, "FILE", "Graph to write (g2o); the list lies beside it")
      .required();
  command.quiet();
  command.on_run([flags, group_size, reach, &context] {
    refuse_unused(*flags, group_size, reach);
    spoil_graph(*flags, context);
  });
}

}  // namespace fathom
