#include "fathom/harness/advice.hpp"

#include <fmt/format.h>

#include "fathom/core/text.hpp"

namespace fathom {
namespace {

// Names a type of the registry; that it is one, a test checks.
Advice chosen(double misfit_rad, const std::string& since) {
  return {misfit_rad > kMisfitOfWrongMinima_rad ? "sparse_gauss_newton" : "incremental_smoother",
          since};
}

std::string against_the_limit(double misfit_rad) {
  return misfit_rad > kMisfitOfWrongMinima_rad
             ? fmt::format("beyond {} rad, where wrong minima begin",
                           short_number(kMisfitOfWrongMinima_rad))
             : fmt::format("within {} rad, below which no wrong minimum was met",
                           short_number(kMisfitOfWrongMinima_rad));
}

std::string filters_text(const LoopTerms& terms) {
  const std::string left = short_number(terms.curvature);
  if (!(terms.curvature < kCurvatureOfFilters)) {
    return fmt::format("one linearisation leaves {} sigma of a loop, so filters may end elsewhere",
                       left);
  }
  std::string text = fmt::format(
      "one linearisation leaves {} sigma of a loop, so trajectory_iekf ends there, too", left);
  if (terms.loops_per_keyframe() < kFewLoopsPerKeyframe)
    text += ", for less while nobody asks for covariances";
  return text;
}

}  // namespace

Advice advise(const LoopTerms& terms) {
  if (terms.loops == 0) {
    return chosen(0.0, "no loop closes a cycle, so nothing bends the map");
  }
  const LoopClosure& turned = terms.most_turned;
  const LoopClosure& moved = terms.most_moved;
  return chosen(
      turned.misfit_rad(),
      fmt::format(
          "its loops miss by up to {} rad (sigma {}) before their update, {}, and by up to {} m "
          "(sigma {}); {}, {} a keyframe, the longest over {} m; {}",
          short_number(turned.misfit_rad()), short_number(turned.sigma_rad()),
          against_the_limit(turned.misfit_rad()), short_number(moved.misfit_m()),
          short_number(moved.sigma_m()), counted(terms.loops, "loop"),
          short_number(terms.loops_per_keyframe()), short_number(terms.longest_m),
          filters_text(terms)));
}

std::optional<Advice> advise(const Outlook& outlook) {
  if (!outlook.widest) return std::nullopt;
  constexpr double kSigmas = 2.0;
  const ReckonedLoop& loop = *outlook.widest;
  const double expected_rad = kSigmas * loop.sigma_rad;
  return chosen(expected_rad,
                fmt::format("dead reckoning leaves a heading sigma of {} rad over the {} m between "
                            "the keyframes of a loop; twice that is {}",
                            short_number(loop.sigma_rad), short_number(loop.way_m),
                            against_the_limit(expected_rad)));
}

std::string text_of(const Advice& advice, const std::string& what) {
  return fmt::format("for this {}: {}, since {}", what, advice.estimator, advice.since);
}

}  // namespace fathom
