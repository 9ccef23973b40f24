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
  if (!result) throw InputError(flags.estimate, "has errors too large for a number");
  const Table relative =
      relative_table(poses, flags);  // refuses what it cannot do before any output
  std::printf("%zu of %zu poses have a reference; alignment %s, scale as it is\n\n", pairs.size(),
              estimate.size(), flags.alignment.c_str());
  Table table({"", "error"});
  table.add_row({"mean position error (m)", format_number(result->mean_position_error_m, 6)});
  table.add_row({"ATE RMSE (m)", format_number(result->ate_rmse_m, 6)});
  table.add_row({"largest position error (m)", format_number(result->max_position_error_m, 6)});
  table.add_row({"final position error (m)", format_number(result->final_position_error_m, 6)});
  table.add_row({"heading RMSE (rad)", format_number(result->heading_rmse_rad, 6)});
  std::printf("%s", table.text().c_str());
  std::printf("\n%s", relative.text().c_str());
  context.status = kDone;
}

}  // namespace

void add_evaluate(CLI::App& app, Context& context) {
  auto flags = std::make_shared<EvaluateFlags>();
  CLI::App* command = app.add_subcommand("evaluate", "Judge a trajectory by a reference");
  command->footer("Example: fathom evaluate runs/run/trajectory.tum runs/run/ground_truth.tum");
  command->add_option("estimate", flags->estimate, "Trajectory (TUM)")->required();
  command->add_option("reference", flags->reference, "Reference trajectory (TUM)")->required();
  command->add_option("--alignment", flags->alignment, "none, origin or se2; never scale")
      ->type_name("NAME")
      ->capture_default_str();
  command
      ->add_option("--max-difference", flags->max_difference_s,
                   "Time stamps that belong together differ by no more (s)")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--step", flags->steps, "Relative error over so many poses (repeatable)")
      ->type_name("N")
      ->check(CLI::PositiveNumber)
      ->allow_extra_args(false);
  command->add_option("--distance", flags->distances_m, "and over so many metres (repeatable)")
      ->type_name("M")
      ->check(CLI::PositiveNumber)
      ->allow_extra_args(false);
  command->callback([flags, &context] { evaluate_files(*flags, context); });
}

}  // namespace fathom
