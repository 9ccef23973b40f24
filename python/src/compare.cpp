// A study, as `fathom compare` runs it.

#include "fathom/workflow/compare.hpp"

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <pybind11/stl.h>
#include <string>
#include <thread>
#include <vector>

#include "fathom/workflow/inputs.hpp"
#include "python/src/bindings.hpp"
#include "python/src/one_thread.hpp"
#include "python/src/solution.hpp"
#include "python/src/work.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

py::dict row_of(const StudyProgress& at) {
  return py::dict(py::arg("done") = at.done, py::arg("of") = at.of, py::arg("failed") = at.failed,
                  py::arg("stage") = at.stage, py::arg("step") = at.step,
                  py::arg("steps") = at.steps, py::arg("left_s") = at.left_s);
}

// Runs a study on another thread, as signals are seen to on this one: Ctrl-C has the trials at work
// left at their next keyframe. What Python's progress throws ends the study, too.
class StoppableStudy : public workflow::Observer {
 public:
  /// `progress` is of Python, or None.
  explicit StoppableStudy(const py::object& progress) : progress_(progress) {}

  void study_progress(const StudyProgress& at) override {
    if (progress_.is_none()) return;
    const py::gil_scoped_acquire lock;
    if (thrown_) return;
    try {
      progress_(row_of(at));
    } catch (const py::error_already_set&) {
      thrown_ = std::current_exception();
      stop_ = true;
    }
  }

  workflow::CompareOutcome run(workflow::CompareRequest& request,
                               const EstimatorRegistry& registry) {
    request.stop = &stop_;
    auto done = std::async(std::launch::async, [&] {
      const OneThread pinned;
      return workflow::compare(request, registry, this_process(), *this);
    });
    while (done.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
      try {
        if (!thrown_) check_signals();
      } catch (const py::error_already_set&) {
        const py::gil_scoped_acquire lock;
        thrown_ = std::current_exception();
        stop_ = true;
      }
    }
    workflow::CompareOutcome result = done.get();
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

  const py::object& progress_;
  std::atomic<bool> stop_ = false;
  std::exception_ptr thrown_;
};

}  // namespace

void bind_compare(py::module_& module) {
  module.def(
      "_compare",
      [](const Settings& settings, const EstimatorRegistry& registry, const std::string& config,
         const std::string& out, const std::string& title,
         const std::optional<std::string>& cache_folder, bool mosaics, const py::object& progress) {
        const py::gil_scoped_release unlocked;
        const std::unique_ptr<RegistrationStore> cache = registrations_in(cache_folder);
        workflow::CompareRequest request;
        request.settings = settings;
        request.inputs = workflow::inputs_of(config, settings);
        request.out = out;
        request.title = title;
        request.made_by = "python: fathom.compare";
        request.mosaics = mosaics;
        request.registrations = cache.get();
        workflow::CompareOutcome done = StoppableStudy(progress).run(request, registry);
        std::vector<Solution> example;
        for (ExampleRun& run : done.example) {
          example.push_back({run.recording, std::move(run.result)});
        }
        return example;
      });
}

}  // namespace fathom
