#include "fathom/workflow/estimate.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "fathom/workflow/compare.hpp"

namespace fathom::workflow {
namespace {

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

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
    for (const double trial : group.trials_s) {
      demand.longest_trial_h = std::max(demand.longest_trial_h, trial / 3600.0);
    }
  }
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
  demand.memory_mib = measured.memory_mib;
  demand.surveys = measured.groups.size() * study.description.surveys;
  demand.trials = trials_in_all(study);
  demand.sampled_trials = measured.trials;
  demand.estimators = study.description.estimators.size();
  return demand;
}

}  // namespace

Demand estimate(const Settings& settings, double seconds, const EstimatorRegistry& registry,
                const Machine& machine, Observer& observer) {
  const Study study = settled_study(settings, registry);
  return demand_of(study, sample_study(study, registry, seconds, machine.on_thread_start,
                                       observer.progress_of("sampling")));
}

}  // namespace fathom::workflow
