// fathom evaluate: a trajectory against a reference.

#include <cstdio>
#include <memory>

#include "apps/command.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/evaluation/accuracy.hpp"
#include "fathom/evaluation/association.hpp"
#include "fathom/report/table.hpp"

namespace fathom {
namespace {

struct EvaluateFlags {
  std::string estimate;
  std::string reference;
  std::string alignment = "origin";
  double max_difference_s = 0.01;
  std::vector<std::size_t> steps{1};
  std::vector<double> distances_m;
};

Alignment alignment_of(const std::string& name) {
  for (const auto& [known, alignment] : alignment_names()) {
    if (known == name) return alignment;
  }
  throw InputError("--alignment: expected none, origin or se2, got '" + name + "'");
}

Table relative_table(const AssociatedPoses& poses, const EvaluateFlags& flags) {
  Table table({"relative error over", "pairs", "translation RMSE (m)", "rotation RMSE (rad)"});
  const auto add = [&table](const std::string& what, const std::optional<RelativeError>& error) {
    table.add_row({what, error ? std::to_string(error->pairs) : "0",
                   error ? format_number(error->translation_rmse_m, 5) : "-",
                   error ? format_number(error->rotation_rmse_rad, 5) : "-"});
  };
  for (const std::size_t step : flags.steps) {
    add(std::to_string(step) + (step == 1 ? " pose" : " poses"),
        relative_error(poses.estimate, poses.reference, step));
  }
  for (const double distance_m : flags.distances_m) {
    add(format_number(distance_m, 3) + " m",
        relative_error_over(poses.estimate, poses.reference, distance_m));
  }
  return table;
}

Table absolute_table(const Accuracy& accuracy) {
  Table table({"", "error"});
  table.add_row({"mean position error (m)", format_number(accuracy.mean_position_error_m, 6)});
  table.add_row({"ATE RMSE (m)", format_number(accuracy.ate_rmse_m, 6)});
  table.add_row({"largest position error (m)", format_number(accuracy.max_position_error_m, 6)});
  table.add_row({"final position error (m)", format_number(accuracy.final_position_error_m, 6)});
  table.add_row({"heading RMSE (rad)", format_number(accuracy.heading_rmse_rad, 6)});
  return table;
}

void evaluate_files(const EvaluateFlags& flags, Context& context) {
  const Alignment alignment = alignment_of(flags.alignment);
  const auto estimate = read_tum(flags.estimate);
  const auto reference = read_tum(flags.reference);
  const auto pairs = associate(estimate, reference, flags.max_difference_s);
  if (pairs.empty()) {
    throw InputError(flags.estimate,
                     "no pose is within " + format_number(flags.max_difference_s, 3) +
                         " s of one of " + flags.reference + "; --max-difference may be larger");
  }
  const AssociatedPoses poses = paired_poses(estimate, reference, pairs);
  const auto result = accuracy(poses.estimate, poses.reference, alignment);
  const bool has_error = leaves_an_error(pairs.size(), alignment);
  if (has_error && !result) {
    throw InputError(flags.estimate, "has errors too large for a number");
  }
  const Table relative =
      relative_table(poses, flags);  // refuses what it cannot do before any output
  std::printf("%zu of %zu poses have a reference; alignment %s, scale as it is\n\n", pairs.size(),
              estimate.size(), flags.alignment.c_str());
  if (result) {
    std::printf("%s", absolute_table(*result).text().c_str());
  } else {
    std::printf("no error can be given: alignment %s lays a single pose on its reference\n",
                flags.alignment.c_str());
  }
  std::printf("\n%s", relative.text().c_str());
  context.status = kDone;
}

}  // namespace

void add_evaluate(CLI::App& program, Context& context) {
  auto flags = std::make_shared<EvaluateFlags>();
  Command command(program, "evaluate", "Judge a trajectory by a reference",
                  "Example: fathom evaluate runs/run/trajectory.tum runs/run/ground_truth.tum");
  command.argument("estimate", flags->estimate, "Trajectory (TUM)");
  command.argument("reference", flags->reference, "Reference trajectory (TUM)");
  command.text("--alignment", flags->alignment, "NAME", "none, origin or se2; never scale");
  command.real("--max-difference", flags->max_difference_s, Range::at_least(0.0), "S",
               "Time stamps that belong together differ by no more (s)");
  command.integers("--step", flags->steps, Range::at_least(1), "N",
                   "Relative error over so many poses (repeatable)");
  command.reals("--distance", flags->distances_m, Range::positive(), "M",
                "and over so many metres (repeatable)");
  command.on_run([flags, &context] { evaluate_files(*flags, context); });
}

}  // namespace fathom
