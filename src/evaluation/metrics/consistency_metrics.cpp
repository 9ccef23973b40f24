#include "groups.hpp"

namespace fathom {

std::vector<Metric> consistency_metrics() {
  const auto of = [](double Consistency::*field) {
    return [field](const JudgedRun& run) -> std::optional<double> {
      if (!run.consistency) return std::nullopt;
      return (*run.consistency).*field;
    };
  };
  return {
      {"anees", "ANEES", "", Better::neither,
       "mean pose NEES divided by 3; 1 expected, above: overconfident", of(&Consistency::anees)},
      {"position_anees", "position ANEES", "", Better::neither,
       "mean position NEES divided by 2; 1 expected", of(&Consistency::position_anees)},
      {"share_inside_2_sigma", "share inside 2σ", "", Better::neither,
       "share of the keyframes with the true position inside the 2σ ellipse; 0.865 expected",
       of(&Consistency::share_inside_2_sigma)},
      anchored_anees_metric(),
  };
}

}  // namespace fathom
