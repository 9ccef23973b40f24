#include "python/src/shared_estimators.hpp"

#include <mutex>
#include <optional>
#include <pybind11/pybind11.h>
#include <string>
#include <utility>

#include "fathom/estimators/builtin.hpp"
#include "fathom/workflow/known_estimators.hpp"

namespace fathom {
namespace {

// A warning of Python's, whose filters say what becomes of it.
void warn(const std::string& line) {
  const pybind11::gil_scoped_acquire lock;
  if (PyErr_WarnEx(PyExc_UserWarning, line.c_str(), 1) != 0) throw pybind11::error_already_set();
}

class SharedEstimators {
 public:
  template <class Action>
  auto with(Action action) {
    // A plug-in in Python may ask for the others as it is read.
    const std::lock_guard lock(mutex_);
    if (!known_) begin();
    return action(*known_);
  }

 private:
  void begin() {
    EstimatorRegistry registry = builtin_estimators();
    registry.add(command_entry());
    known_.emplace(std::move(registry));
    try {
      for (const std::string& line : known_->load_search_path()) warn(line);
    } catch (...) {
      known_.reset();
      throw;
    }
  }

  std::recursive_mutex mutex_;
  std::optional<workflow::KnownEstimators> known_;
};

SharedEstimators& shared() {
  static SharedEstimators shared;
  return shared;
}

}  // namespace

EstimatorRegistry known_estimators_now() {
  return shared().with([](const workflow::KnownEstimators& known) { return known.registry(); });
}

void load_plugins(const std::vector<std::string>& files) {
  shared().with([&](workflow::KnownEstimators& known) {
    for (const std::string& file : files) known.load(file);
  });
}

// Those that run a configuration alone ask for this.
void load_plugins(Settings& settings, const std::vector<std::string>& files) {
  shared().with([&](workflow::KnownEstimators& known) {
    known.load(settings, files, workflow::NamedPlugins::loaded);
  });
}

}  // namespace fathom
