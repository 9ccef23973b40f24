#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "ranking.hpp"

namespace fathom {

// What makes an answer doubtful: a type for each finding, with its figures. A new one is a type
// here, a function of verdict_doubts.cpp that finds it, and its words (doubt_words.cpp).
namespace doubt {

/// An estimator with a figure of its own.
struct Figure {
  std::string estimator;
  MetricSummary summary;
};

/// What a trial's front end made of its candidate pairs, means.
struct FrontEnd {
  double tried = 0.0;
  double registered = 0.0;
};

struct SingleTrial {};
/// All trials have the same measurements and figures.
struct OneResult {
  std::size_t trials = 0;
};
struct FewTrials {
  std::size_t trials = 0;
};
/// Intervals that do not speak of other surveys.
struct OneSurvey {
  std::string limits;  ///< limits_text
};
struct FewSurveys {
  std::size_t surveys = 0;
};
/// The best is not shown to be better than dead reckoning.
struct BaselineAsGood {
  PairedDifference difference;  ///< dead reckoning minus the best
  std::string metric;
  bool is_worse = false;  ///< the best is shown to be worse
};
struct WrongConfidence {
  bool is_overconfident = true;
  std::vector<Figure> anees;
  std::vector<std::string> causes;  ///< cause_words of each
};
/// Registrations of one picture share errors.
struct Correlation {
  MetricSummary correlation;
  std::vector<std::string> estimators;   ///< that do not estimate them
  bool is_told = false;                  ///< whether they could estimate them
  MetricSummary left = {};               ///< less what is estimated of it
  std::vector<std::string> beyond = {};  ///< that estimate errors of pictures, and leave so much
};
/// F lies above the optimum of the measurements.
struct OffTheOptimum {
  std::vector<Figure> gaps;
};
/// Means hold runs without loop closures.
struct WithoutLoops {
  std::vector<std::string> estimators;
  std::optional<FrontEnd> front_end;
};
/// Few of the pairs that overlap are loops.
struct FewLoops {
  double recall = 0.0;
  std::optional<FrontEnd> front_end;
};
/// Measurements do not fit each other.
struct Misfit {
  double chi2_per_degree = 0.0;
};
/// One of those that are compared selected the loops.
struct ContenderSelects {
  std::string selected_by;
};
struct SeveralJobs {
  std::set<int> jobs;
};
/// Much of the time of estimators was none of a processor.
struct BusyMachine {
  double share = 1.0;  ///< of processor time, the least of them
  std::vector<std::string> estimators;
};
struct SeveralMachines {
  std::string machines;  ///< machines_text
};

}  // namespace doubt

using Doubt = std::variant<doubt::SingleTrial, doubt::OneResult, doubt::FewTrials, doubt::OneSurvey,
                           doubt::FewSurveys, doubt::BaselineAsGood, doubt::WrongConfidence,
                           doubt::Correlation, doubt::OffTheOptimum, doubt::WithoutLoops,
                           doubt::FewLoops, doubt::Misfit, doubt::ContenderSelects,
                           doubt::SeveralJobs, doubt::BusyMachine, doubt::SeveralMachines>;

/// Of one cell, with its figures: sentences.
std::string words_of(const Doubt& doubt);

/// Of several cells, without figures: a sentence, or what may follow "in 2 of 3 cells".
std::string words_in_general(const Doubt& doubt);

/// The estimators that it is about; empty where it is about all of a cell.
std::vector<std::string> estimators_of(const Doubt& doubt);

}  // namespace fathom
