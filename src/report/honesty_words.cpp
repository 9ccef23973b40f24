#include "honesty_words.hpp"

#include "fathom/report/table.hpp"

namespace fathom {
namespace {

std::string text_of(const MetricSummary& summary) {
  constexpr int kDigits = 2;
  const std::string mean = format_number(summary.moments.mean, kDigits);
  if (!summary.interval) return mean;
  return mean + " [" + format_number(summary.interval->low, kDigits) + ", " +
         format_number(summary.interval->high, kDigits) + "]";
}

std::string shared_errors_words(const Honesty& honesty, const std::string& cost,
                                const std::string& correlation) {
  std::string text = "The registrations share errors: ";
  if (honesty.agrees_too_well) {
    text +=
        "they agree with one another better than their covariances say (F per degree of "
        "freedom " +
        cost + ")";
  }
  if (honesty.is_correlated) {
    text += std::string(honesty.agrees_too_well ? ", and " : "") +
            "those of one picture have errors with correlation " + correlation;
  }
  if (honesty.estimates_shared_errors)
    return text + ", more than their stated shared errors explain.";
  return text + "; the estimator does not estimate them" +
         (honesty.is_told ? ", shared_errors: states does, where it has it." : ".");
}

}  // namespace

std::string cause_words(const EstimatorResults& one) {
  const auto figure = [&one](const char* metric) {
    const auto found = one.consistency.find(metric);
    return found == one.consistency.end() ? std::string() : text_of(found->second);
  };
  switch (one.honesty ? one.honesty->cause : HonestyCause::unknown) {
    case HonestyCause::off_the_optimum:
      return "The estimate is not at the optimum of the measurements: its F is above it by " +
             figure("chi2_gap") + ", by its linearisation or a wrong minimum.";
    case HonestyCause::first_picture:
      return "With other keyframes held it is " + figure("anchored_anees") +
             ": what is wrong is the first picture, from which every pose is measured.";
    case HonestyCause::shared_errors:
      return shared_errors_words(*one.honesty, figure("chi2_per_dof"),
                                 figure("picture_error_correlation"));
    case HonestyCause::small_registrations:
      return "The covariances of the registrations are too small, or some are wrong: their mean "
             "NIS against truth "
             "is " +
             figure("mean_nis_truth") + ", where 3 is expected.";
    case HonestyCause::linearisation:
      return "The covariances of the registrations are right against truth (mean NIS " +
             figure("mean_nis_truth") +
             ", 3 expected): what is too small is the estimator's own, as linearisation leaves it.";
    case HonestyCause::misfit:
      return "F per degree of freedom is " + figure("chi2_per_dof") +
             ": covariances of the log are too small, or loops are false.";
    case HonestyCause::large_registrations:
      return "The covariances of the registrations are too large: their mean NIS against truth "
             "is " +
             figure("mean_nis_truth") + ", where 3 is expected.";
    case HonestyCause::holes:
      return "The log has holes: keyframes behind one that no measurement bridges have the "
             "covariance that is declared for its guess, which is wide.";
    case HonestyCause::unknown:
      break;
  }
  return "";
}

std::vector<std::string> honesty_words(const EstimatorResults& one) {
  if (!one.honesty) return {};
  std::vector<std::string> words{
      (one.honesty->is_overconfident ? "Overconfident: ANEES is " : "Underconfident: ANEES is ") +
      text_of(one.consistency.at("anees")) + ", where 1 is expected."};
  if (std::string cause = cause_words(one); !cause.empty()) words.push_back(std::move(cause));
  return words;
}

}  // namespace fathom
