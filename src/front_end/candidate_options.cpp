#include "fathom/core/input_error.hpp"
#include "fathom/front_end/candidates.hpp"

namespace fathom {

void CandidateOptions::describe(OptionTable& table) {
  table.enumeration("method", method,
                    {{"automatic", CandidateMethod::automatic},
                     {"distance", CandidateMethod::distance},
                     {"mahalanobis", CandidateMethod::mahalanobis},
                     {"overlap", CandidateMethod::overlap},
                     {"possible_overlap", CandidateMethod::possible_overlap}},
                    "loop candidates: near as estimated; perhaps near, by the estimator's "
                    "uncertainty; pictures that overlap as estimated; or perhaps overlap. "
                    "automatic: distance where max_distance_m is given, else possible_overlap");
  table.real_or_off("max_distance_m", max_distance_m, Range::at_least(0.0), "m",
                    "distance, mahalanobis: keyframes within this distance of the newest, as "
                    "estimated");
  table.real("probability", probability, Range::between(1e-6, 0.999999999999), "",
             "mahalanobis, possible_overlap: and those whose confidence ellipse of so much reaches "
             "there");
  table.real("min_overlap", min_overlap, Range{0.0, 1.0, true}, "",
             "overlap, possible_overlap: share of the smaller footprint that both pictures see, as "
             "estimated");
  table.integer("budget", budget, Range::between(1, 1e6), "keyframes",
                "possible_overlap: so many candidates at most, the best of each pass first");
  table.integer_or_off("max_per_keyframe", max_per_keyframe, Range::at_least(1), "keyframes",
                       "the other methods: so many candidates at most, those of most overlap as "
                       "estimated");
  table.integer("hole_budget", hole_budget, Range::between(0, 1e6), "keyframes",
                "every method: over a hole in dead reckoning that is open, so many of those that "
                "the uncertainty allows; 0: as if there were no hole");
}

CandidateMethod CandidateOptions::method_in_force() const {
  if (method != CandidateMethod::automatic) return method;
  return max_distance_m ? CandidateMethod::distance : CandidateMethod::possible_overlap;
}

bool CandidateOptions::asks_covariances() const {
  const CandidateMethod used = method_in_force();
  return used == CandidateMethod::mahalanobis || used == CandidateMethod::possible_overlap;
}

std::string CandidateOptions::chooser() const {
  return method == CandidateMethod::automatic && max_distance_m ? "max_distance_m" : "method";
}

void CandidateOptions::check() const {
  const bool is_distance =
      method == CandidateMethod::distance || method == CandidateMethod::mahalanobis;
  if (is_distance && !max_distance_m) {
    throw InputError("candidates.method: this one needs candidates.max_distance_m, in metres");
  }
}

std::vector<std::string> CandidateOptions::ignored_keys() const {
  switch (method_in_force()) {
    case CandidateMethod::mahalanobis:
      return {"min_overlap", "budget"};
    case CandidateMethod::overlap:
      return {"max_distance_m", "probability", "budget"};
    case CandidateMethod::possible_overlap:
      // Of `automatic`, that no distance is given is what decides.
      if (method == CandidateMethod::automatic) return {"max_per_keyframe"};
      return {"max_distance_m", "max_per_keyframe"};
    case CandidateMethod::automatic:
    case CandidateMethod::distance:
      break;
  }
  return {"probability", "min_overlap", "budget"};
}

}  // namespace fathom
