#include <algorithm>
#include <fmt/format.h>

#include "doubts.hpp"
#include "fathom/core/text.hpp"
#include "fathom/report/table.hpp"
#include "scaled_unit.hpp"
#include "verdict.hpp"

namespace fathom {
namespace doubt {
namespace {

// "ekf (ANEES 2.1 [1.5, 2.8]) and smoother (ANEES 3.0)"
std::string listed_figures(const std::vector<Figure>& all, const std::string& before,
                           const std::string& after) {
  std::vector<std::string> texts;
  texts.reserve(all.size());
  for (const auto& [estimator, summary] : all) {
    texts.push_back(estimator + before + quantity(summary.moments.mean, summary.interval, "") +
                    after);
  }
  return listed(texts);
}

// ": of 610 candidate pairs a trial 0 registered"; empty of a pose graph.
std::string front_end_words(const std::optional<FrontEnd>& front_end) {
  if (!front_end) return "";
  if (front_end->tried == 0.0) {
    return ": there were no candidate pairs; 'fathom check' of the data says what to expect";
  }
  return fmt::format(": of {} candidate pairs a trial {} registered",
                     short_number(front_end->tried, 4), short_number(front_end->registered, 4));
}

// Each with its figures, and in general.

std::string words(const SingleTrial&) {
  return "A single trial: there is no interval, and the order may be chance.";
}

std::string words(const OneResult& found) {
  return fmt::format(
      "The {} trials have the same measurements: nothing is drawn, and they say no more than one.",
      found.trials);
}

std::string words(const FewTrials& found) {
  return "Only " + std::to_string(found.trials) + " trials.";
}

std::string words(const OneSurvey& found) {
  return found.limits;
}

std::string words(const FewSurveys& found) {
  return "Only " + std::to_string(found.surveys) + " surveys: others may give another order.";
}

std::string words(const BaselineAsGood& found) {
  return std::string(found.is_worse ? "The best is worse than dead reckoning"
                                    : "The best is not shown to be better than dead reckoning") +
         ", whose difference to it is " +
         quantity(found.difference.mean, found.difference.interval, described(found.metric).unit) +
         ".";
}
std::string general(const BaselineAsGood& found) {
  return found.is_worse ? "the best is worse than dead reckoning"
                        : "the best is not shown to be better than dead reckoning";
}

// One for all of them, or that of each by its name.
std::string causes_of(const WrongConfidence& found) {
  const std::string& first = found.causes.front();
  if (std::ranges::all_of(found.causes, [&](const auto& cause) { return cause == first; })) {
    return first.empty() ? "" : " " + first;
  }
  std::string text;
  for (std::size_t i = 0; i < found.causes.size(); ++i) {
    if (found.causes[i].empty()) continue;
    text += " " + found.anees[i].estimator + ": " + found.causes[i];
  }
  return text;
}

std::string words(const WrongConfidence& found) {
  return fmt::format("{}, where 1 is expected: {}.{}",
                     found.is_overconfident ? "Overconfident" : "Underconfident",
                     listed_figures(found.anees, " (ANEES ", ")"), causes_of(found));
}
std::string general(const WrongConfidence& found) {
  return std::string("estimators are ") +
         (found.is_overconfident ? "overconfident" : "underconfident");
}

std::string words(const Correlation& found) {
  const auto figure = [](const MetricSummary& summary) {
    return " (correlation " + quantity(summary.moments.mean, summary.interval, "") + ")";
  };
  std::string text;
  if (!found.estimators.empty()) {
    text = "Registrations of one picture share errors" + figure(found.correlation) + ", which " +
           listed(found.estimators) + (found.estimators.size() == 1 ? " does" : " do") +
           " not estimate" +
           (found.is_told ? "; shared_errors: states estimates them, of those that have it." : ".");
  }
  if (!found.beyond.empty()) {
    text += std::string(text.empty() ? "" : " ") + "Registrations of one picture share more than " +
            listed(found.beyond) + (found.beyond.size() == 1 ? " estimates" : " estimate") +
            figure(found.left) + ".";
  }
  return text;
}
std::string general(const Correlation& found) {
  return found.estimators.empty()
             ? "registrations of one picture share more than estimators estimate"
             : "registrations of one picture share errors that are not estimated";
}

std::string words(const OffTheOptimum& found) {
  return "F above the optimum of the measurements: " + listed_figures(found.gaps, " by ", "") + ".";
}
std::string general(const OffTheOptimum&) {
  return "estimates are not at the optimum of the measurements";
}

std::string words(const WithoutLoops& found) {
  return fmt::format(
      "The means of {} hold runs without loop closures, which are dead reckoning and absolute "
      "measurements, if there are any{}.",
      listed(found.estimators), front_end_words(found.front_end));
}
std::string general(const WithoutLoops&) {
  return "means hold runs without loop closures";
}

std::string words(const FewLoops& found) {
  return fmt::format("Of the pairs of keyframes that overlap well no more than {} % are loops{}.",
                     format_number(100.0 * found.recall, 2), front_end_words(found.front_end));
}
std::string general(const FewLoops&) {
  return "few of the pairs that overlap are loops";
}

std::string words(const Misfit& found) {
  return "Measurements do not fit each other: F per degree of freedom is " +
         format_number(found.chi2_per_degree, 3) +
         " at its best, where 1 is expected; covariances of registrations or of dead reckoning "
         "are too small, or loops are wrong.";
}
std::string general(const Misfit&) {
  return "measurements do not fit each other";
}

std::string words(const ContenderSelects& found) {
  return "Loops were selected by " + found.selected_by + ": the others replay what suited it.";
}

std::string words(const SeveralJobs& found) {
  return "Costs were measured with " + counts_text(found.jobs) +
         " jobs at a time; they are comparable at 1 alone.";
}

std::string words(const BusyMachine& found) {
  return fmt::format(
      "Of the time of {} {}{} % was processor time: the machine was busy with something else, or "
      "they wait for another process or a device; times are comparable where nothing else runs.",
      listed(found.estimators), found.estimators.size() == 1 ? "" : "as little as ",
      format_number(100.0 * found.share, 2));
}
std::string general(const BusyMachine&) {
  return "the machine was busy with something else, and times are not comparable";
}

std::string words(const SeveralMachines& found) {
  return found.machines;
}

}  // namespace
}  // namespace doubt

std::string words_of(const Doubt& doubt) {
  return std::visit([](const auto& found) { return doubt::words(found); }, doubt);
}

std::vector<std::string> estimators_of(const Doubt& doubt) {
  const auto named = [](const std::vector<doubt::Figure>& figures) {
    std::vector<std::string> names;
    names.reserve(figures.size());
    for (const doubt::Figure& figure : figures) names.push_back(figure.estimator);
    return names;
  };
  return std::visit(
      [&named](const auto& found) -> std::vector<std::string> {
        if constexpr (requires { found.estimators; }) return found.estimators;
        if constexpr (requires { found.anees; }) return named(found.anees);
        if constexpr (requires { found.gaps; }) return named(found.gaps);
        return {};
      },
      doubt);
}

std::string words_in_general(const Doubt& doubt) {
  return std::visit(
      [](const auto& found) {
        if constexpr (requires { doubt::general(found); }) return doubt::general(found);
        return doubt::words(found);
      },
      doubt);
}

}  // namespace fathom
