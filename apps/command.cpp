#include "apps/command.hpp"

#include "apps/output.hpp"
#include "fathom/estimators/builtin.hpp"

namespace fathom {

workflow::KnownEstimators& Context::estimators() {
  if (!estimators_) {
    EstimatorRegistry begin = builtin_estimators();
    begin.add(command_entry());
    workflow::KnownEstimators known(std::move(begin));
    for (const std::string& line : known.load_search_path()) print_note(line);
    estimators_ = std::move(known);
  }
  return *estimators_;
}

}  // namespace fathom
