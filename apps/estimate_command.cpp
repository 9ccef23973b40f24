// fathom estimate: what a study will take, from a few of its trials.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "apps/terminal.hpp"
#include "fathom/report/table.hpp"
#include "fathom/workflow/estimate.hpp"

namespace fathom {
namespace {

struct EstimateFlags {
  CommonFlags common;
  std::string config;
  double seconds = 60.0;
  int shards = 1;
};

// For a job's request: twice what was found, as trials differ.
std::string request_of(const workflow::Demand& demand, std::size_t shards) {
  constexpr double kMargin = 2.0;
  const double hours =
      std::max(demand.runs_h / static_cast<double>(shards), demand.longest_trial_h);
  const auto minutes = static_cast<long>(std::ceil(kMargin * 60.0 * hours)) + 1;
  const auto mib = 256 * static_cast<long>(std::ceil(kMargin * demand.memory_mib / 256.0));
  return fmt::format("#SBATCH --array=1-{} --cpus-per-task=1 --time={} --mem={}M\n", shards,
                     minutes, mib);
}

void print_demand(const workflow::Demand& demand, int shards) {
  Table table({"", "processor hours", "disk (MiB)", "of"});
  table.add_row({"registrations", format_number(demand.registrations_h, 2),
                 format_number(demand.cache_mib, 2), counted(demand.surveys, "survey")});
  table.add_row({"runs", format_number(demand.runs_h, 2), format_number(demand.store_mib, 2),
                 fmt::format("{} trials with {} estimators", demand.trials, demand.estimators)});
  print("%s\n", table.text().c_str());
  print(
      "Memory: %.0f MiB a job. From %zu trial%s run here; other trials register "
      "pairs of their own, and other machines are faster or slower.\n",
      std::ceil(demand.memory_mib), demand.sampled_trials,
      demand.sampled_trials == 1 ? " that was" : "s that were");
  const std::size_t cut = std::min(static_cast<std::size_t>(shards), demand.trials);
  print("A request of twice that, in %zu shard%s%s, pictures registered before:\n%s", cut,
        cut == 1 ? "" : "s", cut == demand.trials ? ", one for each trial" : "",
        request_of(demand, cut).c_str());
}

void estimate(const EstimateFlags& flags) {
  Terminal terminal(flags.common.quiet);
  const Settings settings = flags.common.settings(flags.config, workflow::NamedPlugins::loaded);
  const workflow::Demand demand = workflow::estimate(
      settings, flags.seconds, flags.common.estimators(), this_program(), terminal);
  terminal.clear();
  if (!flags.common.quiet) print_demand(demand, flags.shards);
}

}  // namespace

void add_estimate(CLI::App& program, Context& context) {
  auto flags = std::make_shared<EstimateFlags>();
  Command command(program, "estimate", "Say what a study will take, from a few of its trials",
                  "Example: fathom estimate configs/studies/regimes.yaml --shards 64\n"
                  "Runs the first trial of as many cells as the time allows, and says processor "
                  "hours,\nmemory and disk of the whole study, for a job's request.");
  command.argument("config", flags->config, "Study (YAML)");
  flags->common.add_settings_to(command, context);
  command.real("--seconds", flags->seconds, Range::at_least(0), "S",
               "No further trial begins after so long");
  command.integer("--shards", flags->shards, Range::between(1, 1e6), "N",
                  "Shards that the study is cut in");
  command.on_run([flags, &context] {
    context.status = kDone;
    estimate(*flags);
  });
}

}  // namespace fathom
