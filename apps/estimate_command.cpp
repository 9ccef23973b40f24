// fathom estimate: what a study will take, from a few of its trials.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/estimators.hpp"
#include "apps/pin_threads.hpp"
#include "fathom/harness/ground_truth.hpp"
#include "fathom/harness/study_run.hpp"
#include "fathom/harness/study_sample.hpp"
#include "fathom/report/table.hpp"

namespace fathom {
namespace {

struct EstimateFlags {
  CommonFlags common;
  std::string config;
  double seconds = 60.0;
  int shards = 1;
};

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// What the whole study takes.
struct Demand {
  double registrations_h = 0.0;
  double runs_h = 0.0;
  double store_mib = 0.0;
  double cache_mib = 0.0;
};

// A group or a cell without a trial takes what the others take on average.
Demand demand_of(const Study& study, const StudySample& measured) {
  const auto surveys = static_cast<double>(study.description.surveys);
  const auto trials = surveys * static_cast<double>(study.description.trials);
  std::vector<double> registrations_s;
  std::vector<double> trials_s;
  for (const SampledPictures& group : measured.groups) {
    if (group.trials_s.empty()) continue;
    registrations_s.push_back(group.registrations_s);
    trials_s.push_back(mean_of(group.trials_s));
  }
  Demand demand;
  for (const SampledPictures& group : measured.groups) {
    const bool is_measured = !group.trials_s.empty();
    const double registration = is_measured ? group.registrations_s : mean_of(registrations_s);
    const double trial = mean_of(is_measured ? group.trials_s : trials_s);
    demand.registrations_h += registration * surveys / 3600.0;
    demand.runs_h += trial * trials * static_cast<double>(group.cells.size()) / 3600.0;
  }
  const auto sampled = static_cast<double>(measured.trials);
  const auto groups = static_cast<double>(registrations_s.size());
  demand.store_mib =
      measured.store_mib / sampled * trials * static_cast<double>(study.cells.size());
  demand.cache_mib =
      measured.cache_mib / groups * surveys * static_cast<double>(measured.groups.size());
  return demand;
}

// For a job's request: twice what was found, as trials differ.
std::string request_of(const Demand& demand, const StudySample& measured, int shards) {
  constexpr double kMargin = 2.0;
  const double hours = demand.runs_h / shards;
  const auto minutes = static_cast<long>(std::ceil(kMargin * 60.0 * hours)) + 1;
  const auto mib = 256 * static_cast<long>(std::ceil(kMargin * measured.memory_mib / 256.0));
  return "#SBATCH --array=1-" + std::to_string(shards) +
         " --cpus-per-task=1 --time=" + std::to_string(minutes) + " --mem=" + std::to_string(mib) +
         "M\n";
}

void print(const Study& study, const StudySample& measured, const EstimateFlags& flags) {
  const Demand demand = demand_of(study, measured);
  const std::size_t trials = trials_in_all(study);
  Table table({"", "processor hours", "disk (MiB)", "of"});
  table.add_row({"registrations", format_number(demand.registrations_h, 2),
                 format_number(demand.cache_mib, 2),
                 std::to_string(measured.groups.size() * study.description.surveys) + " surveys"});
  table.add_row({"runs", format_number(demand.runs_h, 2), format_number(demand.store_mib, 2),
                 std::to_string(trials) + " trials with " +
                     std::to_string(study.description.estimators.size()) + " estimators"});
  std::printf("%s\n", table.text().c_str());
  std::printf(
      "Memory: %.0f MiB a job. From %zu trial%s run here; other trials register "
      "pairs of their own, and other machines are faster or slower.\n",
      std::ceil(measured.memory_mib), measured.trials,
      measured.trials == 1 ? " that was" : "s that were");
  std::printf("A request of twice that, in %d shard%s, pictures registered before:\n%s",
              flags.shards, flags.shards == 1 ? "" : "s",
              request_of(demand, measured, flags.shards).c_str());
}

void estimate(const EstimateFlags& flags) {
  Study study = configure_study(flags.common.settings(flags.config), estimators());
  settle_reference(study, estimators());
  study.description.data = with_code(data_of(study), estimators_in(study.cells), estimators());
  ProgressLine line("sampling", flags.common.quiet);
  const StudySample sample =
      sample_study(study, estimators(), flags.seconds, pin_threads, line.callback());
  print(study, sample, flags);
}

}  // namespace

void add_estimate(CLI::App& program, Context& context) {
  auto flags = std::make_shared<EstimateFlags>();
  Command command(program, "estimate", "Say what a study will take, from a few of its trials",
                  "Example: fathom estimate configs/studies/regimes.yaml --shards 64\n"
                  "Runs the first trial of as many cells as the time allows, and says processor "
                  "hours,\nmemory and disk of the whole study, for a job's request.");
  command.argument("config", flags->config, "Study (YAML)");
  flags->common.add_settings_to(command);
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
