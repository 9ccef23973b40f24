#pragma once

#include <span>
#include <vector>

#include "fathom/estimation/estimator.hpp"

namespace fathom {

/// Which of the registrations given to a graph it uses, in the order given.
class UsedLoops {
 public:
  /// After an update, with the final decisions on its registrations.
  void note(const UpdateReport& report);

  /// A weight for every registration given (Estimator::loop_weights): of those used the next of
  /// `of_used`, 0 of the others.
  std::vector<double> weights(std::span<const double> of_used) const;

 private:
  std::vector<bool> is_used_;
};

}  // namespace fathom
