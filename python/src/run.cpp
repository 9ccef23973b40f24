// A data set, one estimator, as `fathom run` runs it.

#include "fathom/workflow/run.hpp"

#include <memory>
#include <optional>
#include <pybind11/stl.h>
#include <string>
#include <utility>

#include "fathom/workflow/inputs.hpp"
#include "python/src/bindings.hpp"
#include "python/src/one_thread.hpp"
#include "python/src/solution.hpp"
#include "python/src/work.hpp"

namespace fathom {

namespace py = pybind11;

void bind_run(py::module_& module) {
  module.def("_run",
             [](const Settings& settings, const EstimatorRegistry& registry,
                const std::string& config, const std::string& out,
                const std::optional<std::string>& cache_folder, const py::object& progress) {
               const py::gil_scoped_release unlocked;
               const std::unique_ptr<RegistrationStore> cache = registrations_in(cache_folder);
               workflow::RunRequest request;
               request.settings = settings;
               request.inputs = workflow::inputs_of(config, settings);
               request.out = out;
               request.title = workflow::stem_of(config);
               request.made_by = "python: fathom.run";
               request.mosaics = false;
               request.registrations = cache.get();
               InterruptibleWork work(progress);
               const OneThread pinned;
               workflow::RunOutcome done = workflow::run(request, registry, this_process(), work);
               return Solution{done.recording, std::move(done.result), std::move(work.remarks)};
             });
}

}  // namespace fathom
