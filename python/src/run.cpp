// A data set, one estimator, as `fathom run` runs it.

#include <filesystem>
#include <memory>
#include <optional>
#include <pybind11/stl.h>
#include <string>

#include "apps/common.hpp"
#include "apps/estimators.hpp"
#include "fathom/configuration/configuration.hpp"
#include "fathom/core/files.hpp"
#include "fathom/harness/manifest.hpp"
#include "fathom/harness/run_folder.hpp"
#include "python/src/bindings.hpp"
#include "python/src/one_thread.hpp"
#include "python/src/recording_cache.hpp"
#include "python/src/solution.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

Solution run(const Settings& settings, const EstimatorRegistry& registry, const std::string& config,
             const std::string& out, const std::optional<std::string>& cache_folder) {
  const Configuration configuration = configure(settings, ConfigurationKind::single, registry);
  std::optional<StagedFolder> folder;
  if (!out.empty()) folder.emplace(out, inputs_of(config, settings));
  const std::unique_ptr<RegistrationStore> cache = recording_cache(cache_folder);
  const OneThread pinned;
  const Recorder recorder(configuration, cache.get());
  const auto recording = std::make_shared<const Recording>(
      recorder.record(configuration, configuration.reference, registry,
                      {static_cast<std::uint64_t>(configuration.seed), 0},
                      [](const FrontEndProgress&) { check_signals(); }));
  const EstimatorConfiguration& estimator = configuration.estimators.front();
  ReplayOptions options = replay_options(configuration, estimator);
  options.progress = [](std::size_t, std::size_t) { check_signals(); };
  Solution solution{recording, evaluate(*recording, estimator, registry,
                                        {.metrics = metric_options(configuration)}, options)};
  if (folder) {
    const Fingerprint data =
        with_code(fingerprint(recorder.data().files()), estimators_in({configuration}), registry);
    write_run(folder->path(), *recording, solution.result,
              manifest_json("python: fathom.run", configuration.in_force, data, *recording,
                            solution.result, registry));
    folder->commit(optional_run_files());
  }
  return solution;
}

}  // namespace

std::unique_ptr<RegistrationStore> recording_cache(const std::optional<std::string>& folder) {
  if (!folder) return nullptr;
  constexpr bool kQuiet = true;
  return open_registrations(
      folder->empty() ? default_cache_folder() : std::filesystem::path(*folder), kQuiet);
}

void bind_run(py::module_& module) {
  module.def("_run", [](const Settings& settings, const EstimatorRegistry& registry,
                        const std::string& config, const std::string& out,
                        const std::optional<std::string>& cache) {
    const py::gil_scoped_release unlocked;
    return run(settings, registry, config, out, cache);
  });
}

}  // namespace fathom
