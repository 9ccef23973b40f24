#include "fathom/harness/study_sample.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <system_error>

#include "fathom/core/system.hpp"
#include "fathom/core/work_folder.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "fathom/harness/study_run.hpp"
#include "fathom/harness/survey.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

double mib_of(const fs::path& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  return error ? 0.0 : static_cast<double>(size) / 1048576.0;
}

std::vector<SampledPictures> groups_of(const Study& study) {
  std::map<std::string, std::size_t> places;
  std::vector<SampledPictures> groups;
  for (std::size_t cell = 0; cell < study.cells.size(); ++cell) {
    const auto [place, is_new] = places.emplace(picture_settings(study.cells[cell]), groups.size());
    if (is_new) groups.emplace_back();
    groups[place->second].cells.push_back(cell);
  }
  return groups;
}

/// Makes single trials of a study and says what they took.
class Sampler {
 public:
  Sampler(const Study& study, const EstimatorRegistry& registry,
          const std::function<void()>& on_thread_start)
      : study_(study),
        registry_(registry),
        cache_(folder_.path() / "cache"),
        store_(ResultStore::write(folder_.path() / "store", study.description, "{}\n")) {
    options_.registrations = &cache_;
    options_.on_thread_start = on_thread_start;
  }

  /// Processor seconds of the registrations of a cell's first trial.
  double register_first(std::size_t cell) {
    options_.sample = cell;
    return seconds_of([&] { register_pictures(study_, registry_, options_); });
  }

  /// Of its runs.
  double run_first(std::size_t cell) {
    options_.sample = cell;
    return seconds_of([&] { run_study(study_, registry_, store_, options_); });
  }

  /// Of the results alone, without what any store has.
  double store_mib() {
    store_.finish();
    ResultStore::write(folder_.path() / "empty", study_.description, "{}\n").finish();
    return std::max(0.0, mib_of(folder_.path() / "store" / kResultsFile) -
                             mib_of(folder_.path() / "empty" / kResultsFile));
  }
  double cache_mib() {
    cache_.finish();
    return mib_of(folder_.path() / "cache" / "registrations.sqlite");
  }

 private:
  template <class Action>
  static double seconds_of(Action action) {
    const double start = processor_seconds();
    action();
    return processor_seconds() - start;
  }

  const Study& study_;
  const EstimatorRegistry& registry_;
  WorkFolder folder_{"fathom-estimate"};
  RegistrationStore cache_;
  ResultStore store_;
  StudyRunOptions options_;
};

}  // namespace

StudySample sample_study(const Study& study, const EstimatorRegistry& registry, double budget_s,
                         const std::function<void()>& on_thread_start, const Progress& progress) {
  StudySample measured;
  measured.groups = groups_of(study);
  Sampler sampler(study, registry, on_thread_start);
  const auto start = std::chrono::steady_clock::now();
  const auto is_over = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() >
           budget_s;
  };
  for (std::size_t round = 0, left = 1; left > 0; ++round) {
    left = 0;
    for (SampledPictures& group : measured.groups) {
      if (round >= group.cells.size() || (measured.trials > 0 && is_over())) continue;
      ++left;
      const std::size_t cell = group.cells[round];
      const double registrations_s = sampler.register_first(cell);
      const double trial_s = sampler.run_first(cell);
      if (round == 0) group.registrations_s = std::max(0.0, registrations_s);
      group.trials_s.push_back(trial_s);
      ++measured.trials;
      if (progress) progress(measured.trials, study.cells.size());
    }
  }
  measured.store_mib = sampler.store_mib();
  measured.cache_mib = sampler.cache_mib();
  measured.memory_mib = peak_memory_mib();
  return measured;
}

}  // namespace fathom
