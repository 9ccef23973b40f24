#include "fathom/measurements/decision.hpp"

#include <algorithm>

namespace fathom {

std::string name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::converged:
      return "converged";
    case Outcome::iteration_limit:
      return "iteration_limit";
    case Outcome::diverged:
      return "diverged";
    case Outcome::numerical_failure:
      return "numerical_failure";
    case Outcome::crashed:
      return "crashed";
    case Outcome::timed_out:
      return "timed_out";
    case Outcome::out_of_memory:
      break;
  }
  return "out_of_memory";
}

std::string name_of(LoopFate fate) {
  switch (fate) {
    case LoopFate::used:
      return "used";
    case LoopFate::rejected:
      return "rejected";
    case LoopFate::lost:
      break;
  }
  return "lost";
}

Outcome worse(Outcome a, Outcome b) {
  return std::max(a, b);
}

bool is_done(Outcome outcome) {
  return outcome <= Outcome::iteration_limit;
}

}  // namespace fathom
