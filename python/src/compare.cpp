// A study, as `fathom compare` runs it.

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <pybind11/stl.h>
#include <string>
#include <thread>
#include <vector>

#include "apps/common.hpp"
#include "apps/estimators.hpp"
#include "apps/study_example.hpp"
#include "apps/study_files.hpp"
#include "fathom/harness/ground_truth.hpp"
#include "fathom/harness/manifest.hpp"
#include "fathom/harness/study_run.hpp"
#include "fathom/results/store_folder.hpp"
#include "python/src/bindings.hpp"
#include "python/src/one_thread.hpp"
#include "python/src/recording_cache.hpp"
#include "python/src/solution.hpp"

namespace fathom {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

constexpr const char* kCommand = "python: fathom.compare";

struct Asked {
  std::string config;  ///< the file, or empty
  fs::path out;
  std::string title;
  std::optional<std::string> cache;  ///< of registrations; "" is the default folder
  bool mosaics = false;
  py::object progress;  ///< of Python, or None
};

py::dict row_of(const StudyProgress& at) {
  return py::dict(py::arg("done") = at.done, py::arg("of") = at.of, py::arg("failed") = at.failed,
                  py::arg("stage") = at.stage, py::arg("step") = at.step,
                  py::arg("steps") = at.steps, py::arg("left_s") = at.left_s);
}

// Runs it on another thread, as signals are seen to on this one: Ctrl-C has the trials at work
// left at their next keyframe. What Python's progress throws ends the study, too.
class StoppableStudy {
 public:
  StoppableStudy(const Asked& asked, StudyRunOptions& options) : options_(options) {
    options.stop = &stop_;
    if (asked.progress.is_none()) return;
    options.progress = [this, &asked](const StudyProgress& at) {
      const py::gil_scoped_acquire lock;
      if (thrown_) return;
      try {
        asked.progress(row_of(at));
      } catch (const py::error_already_set&) {
        thrown_ = std::current_exception();
        stop_ = true;
      }
    };
  }

  StudyRun run(const Study& study, const EstimatorRegistry& registry, ResultStore& store) {
    auto done =
        std::async(std::launch::async, [&] { return run_study(study, registry, store, options_); });
    while (done.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
      try {
        if (!thrown_) check_signals();
      } catch (const py::error_already_set&) {
        const py::gil_scoped_acquire lock;
        thrown_ = std::current_exception();
        stop_ = true;
      }
    }
    StudyRun result = done.get();
    if (thrown_) rethrow();
    return result;
  }

 private:
  // An exception of Python is dropped with the lock alone.
  [[noreturn]] void rethrow() {
    const py::gil_scoped_acquire lock;
    const std::exception_ptr thrown = std::exchange(thrown_, nullptr);
    std::rethrow_exception(thrown);
  }

  StudyRunOptions& options_;
  std::atomic<bool> stop_ = false;
  std::exception_ptr thrown_;
};

std::vector<Solution> compare(const Settings& settings, const EstimatorRegistry& registry,
                              const Asked& asked) {
  Study study = configure_study(settings, registry);
  require_separate(asked.out, study, inputs_of(asked.config, settings));
  settle_reference(study, registry);
  study.description.data = with_code(data_of(study), estimators_in(study.cells), registry);
  const std::unique_ptr<RegistrationStore> cache = recording_cache(asked.cache);
  const Recorder data_set(study.cells.front(), cache.get());
  const OneThread pinned;
  StudyRunOptions options;
  options.jobs = jobs_of(study);
  options.registrations = cache.get();
  options.on_thread_start = OneThread::pin_this_thread;
  StoreFolder folder(asked.out, study.description, session_json(kCommand, options.jobs));
  StudyRun done;
  {
    StoppableStudy stoppable(asked, options);
    done = stoppable.run(study, registry, folder.store());
  }
  folder.store().finish();
  const std::string title = study.description.title.empty() ? asked.title : study.description.title;
  write_example(asked.out, study, done.example, title,
                asked.mosaics ? data_set.pictures() : nullptr, true, registry, kCommand);
  write_study_files(folder.store(), asked.out, true);
  std::vector<Solution> example;
  for (ExampleRun& run : done.example) example.push_back({run.recording, std::move(run.result)});
  return example;
}

}  // namespace

void bind_compare(py::module_& module) {
  module.def("_compare",
             [](const Settings& settings, const EstimatorRegistry& registry,
                const std::string& config, const std::string& out, const std::string& title,
                const std::optional<std::string>& cache, bool mosaics, const py::object& progress) {
               const Asked asked{config, out, title, cache, mosaics, progress};
               const py::gil_scoped_release unlocked;
               return compare(settings, registry, asked);
             });
}

}  // namespace fathom
