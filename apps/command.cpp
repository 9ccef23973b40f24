#include "apps/command.hpp"

#include "fathom/estimators/builtin.hpp"

namespace fathom {

workflow::KnownEstimators& Context::estimators() {
  if (!estimators_) {
    EstimatorRegistry begin = builtin_estimators();
    begin.add(command_entry());
    workflow::KnownEstimators known(std::move(begin));
    known.load_search_path();
    estimators_ = std::move(known);
  }
  return *estimators_;
}

}  // namespace fathom
