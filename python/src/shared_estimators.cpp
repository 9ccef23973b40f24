#include "python/src/shared_estimators.hpp"

#include <mutex>
#include <optional>
#include <utility>

#include "fathom/estimators/builtin.hpp"
#include "fathom/workflow/known_estimators.hpp"

namespace fathom {
namespace {

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
      known_->load_search_path();
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
