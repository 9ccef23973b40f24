#include "fathom/vision/registration.hpp"

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <utility>

#include "decision.hpp"
#include "match_set.hpp"
#include "motion_fit.hpp"
#include "motion_search.hpp"
#include "pair_ransac.hpp"
#include "stationary.hpp"

namespace fathom {
namespace {

void require_points(const FloorFeatures& picture) {
  const std::size_t rows = static_cast<std::size_t>(picture.features.descriptors.rows);
  if (picture.points.size() != rows) {
    throw InputError(fmt::format("features need a point for each descriptor, got {} and {}",
                                 picture.points.size(), rows));
  }
  const bool sized = !picture.sizes_m.empty() || !picture.headings_rad.empty();
  if (sized && (picture.sizes_m.size() != rows || picture.headings_rad.size() != rows)) {
    throw InputError("features need a size and a heading for each descriptor, or none of either");
  }
}

std::vector<Match> picked(const MatchSet& set, const std::vector<int>& indices) {
  std::vector<Match> matches;
  matches.reserve(indices.size());
  for (const int index : indices) {
    matches.push_back(set.matches()[static_cast<std::size_t>(index)]);
  }
  return matches;
}

std::string too_few(std::size_t matches, const RansacOptions& options) {
  return fmt::format("{} matches, {} are needed", matches, options.min_inliers);
}

std::string why_not(const Consensus& consensus, std::size_t matches, const RansacOptions& options) {
  if (static_cast<int>(matches) < options.min_inliers) return too_few(matches, options);
  const std::string agree = fmt::format("{} of {} matches agree", consensus.most_inliers, matches);
  if (consensus.most_inliers < options.min_inliers) {
    return fmt::format("{}, {} are needed", agree, options.min_inliers);
  }
  return fmt::format("{}, in {} places, {} are needed", agree, consensus.most_places,
                     options.min_places);
}

// `matched`: before those of unlike size were left out. Of matches by chance alone some half are.
std::string no_hypothesis(std::size_t matched, std::size_t putative,
                          const RegistrationOptions& options) {
  constexpr std::size_t kFew = 10;
  if (static_cast<int>(matched) >= options.ransac.min_inliers && kFew * putative < matched) {
    return fmt::format(
        "the altitudes disagree with the sizes of keypoints: {} of {} matches remain", putative,
        matched);
  }
  return static_cast<int>(putative) < options.ransac.min_inliers
             ? too_few(putative, options.ransac)
             : "no two of " + std::to_string(putative) + " matches agree";
}

// The two pictures of one pair, and how they are to be registered.
struct Pair {
  const FloorFeatures& from;
  const FloorFeatures& to;
  const RegistrationOptions& options;
  std::uint64_t seed;

  MatchSet set(std::vector<Match> matches, MatchSet::Use use) const {
    return {std::move(matches), from, to, use, options.tuning.matching};
  }

  // A part of the vehicle in view is no rival: that it stays says nothing of the floor.
  Rivals rivals(const Hypothesis& best, const MatchSet& putative, const MatchSet& nearest) const {
    const auto moving = [this](const MatchSet& all) {
      return all.without(staying(from.features, to.features, all.matches()));
    };
    return find_rivals(best, moving(putative), moving(nearest), options, seed);
  }
};

Registration refused(Registration result, std::string reason) {
  result.reason = std::move(reason);
  return result;
}

// The motion and its covariance, unless it is that of something in view.
Registration accepted(Registration result, const Pair& pair, const MotionFit& fit,
                      const MatchSet& matches) {
  result.inliers = picked(matches, fit.inliers);
  std::string stays =
      reason_of_what_stays(pair.from.features, pair.to.features, result.inliers, result.putative);
  if (!stays.empty()) return refused(std::move(result), std::move(stays));
  result.found = true;
  result.motion = fit.motion;
  result.rms_m = fit.rms_m;
  const ScaleCheck check = check_scale(fit, matches);
  result.evidence.scale = check.scale;
  result.evidence.scale_sigma = check.sigma;
  set_covariance(result, fit, matches, pair.from, pair.to, pair.options);
  return result;
}

// The paper's figure 2 as it stands: RANSAC around find_motion (equations 1 to 3), and a motion is
// found if it has enough inliers.
Registration by_inliers(const Pair& pair, const NearestRows& neighbours) {
  const MatchSet putative =
      pair.set(match(neighbours, pair.options.matching), MatchSet::Use::points_alone);
  Registration result;
  result.putative = putative.matches();
  Consensus consensus =
      ransac(putative.pairs(), pair.options.ransac, pair.seed, pair.options.tuning.ransac);
  result.evidence.support = consensus.most_inliers;
  result.evidence.places = consensus.most_places;
  if (!consensus.motion) {
    return refused(std::move(result), why_not(consensus, putative.size(), pair.options.ransac));
  }
  return accepted(std::move(result), pair,
                  {*consensus.motion, std::move(consensus.inliers), consensus.rms_m}, putative);
}

// The strongest features alone; a picture has them in this order.
FloorFeatures strongest(const FloorFeatures& picture, std::size_t count) {
  FloorFeatures first;
  const std::size_t kept = std::min(count, picture.size());
  const auto take = [kept](auto& to, const auto& from) {
    to.assign(from.begin(),
              from.begin() + static_cast<std::ptrdiff_t>(std::min(kept, from.size())));
  };
  take(first.points, picture.points);
  take(first.sizes_m, picture.sizes_m);
  take(first.headings_rad, picture.headings_rad);
  first.features.descriptors = picture.features.descriptors.rowRange(0, static_cast<int>(kept));
  first.viewpoint = picture.viewpoint;
  return first;
}

// Most pairs that do not overlap are told by a part of their features, for a part of the time: the
// same test as of all of them, but lenient. Nothing is refused that is not as good by chance.
std::optional<Registration> refused_at_first(const Pair& pair) {
  const DecisionOptions& decision = pair.options.decision;
  if (!decision.first_features) return std::nullopt;
  const auto count = static_cast<std::size_t>(*decision.first_features);
  // Where few are left out there is nothing to gain.
  if (2 * pair.from.size() * pair.to.size() < 3 * count * count) return std::nullopt;
  const FloorFeatures from = strongest(pair.from, count);
  const FloorFeatures to = strongest(pair.to, count);
  const Pair first{from, to, pair.options, pair.seed};
  const NearestRows neighbours = find_nearest(from.features, to.features);
  const std::vector<Match> matched = match(neighbours, pair.options.matching);
  const MatchSet putative = first.set(matched, MatchSet::Use::sizes);
  const MatchSet nearest = first.set(all_nearest(neighbours), MatchSet::Use::sizes);
  Registration result;
  result.putative = putative.matches();
  const Hypothesis best = find_hypothesis(putative, nearest, pair.options, pair.seed);
  const std::string of = "of the " + std::to_string(count) + " strongest features: ";
  if (!best.motion) {
    return refused(std::move(result),
                   of + no_hypothesis(matched.size(), putative.size(), pair.options));
  }
  // By the pixels of all features, of which the strongest are the first.
  const Rivals rivals = pair.rivals(best, putative, nearest);
  result.evidence = weigh(best, rivals, nearest, pair.options);
  constexpr int kFewest = 3;  // two make any motion
  const bool is_better = result.evidence.places >= kFewest &&
                         result.evidence.false_alarms <= decision.first_max_false_alarms;
  // More matches in fewer places, as a part of the vehicle has them, hide the motion of the floor.
  const bool is_outdone = result.evidence.rival_places > result.evidence.places;
  if (is_better || is_outdone) return std::nullopt;
  result.inliers = picked(nearest, best.support);
  const std::string reason =
      fmt::format("{}{} matches agree, in {} places; another motion has {}", of,
                  result.evidence.support, result.evidence.places, result.evidence.rival_places);
  return refused(std::move(result), reason);
}

// Ours: figure 2 makes the hypothesis; an a-contrario test against its strongest rival decides, and
// a weighted fit to all matches that are nearest one way at least follows.
Registration by_false_alarms(const Pair& pair, const NearestRows& neighbours) {
  const RegistrationOptions& options = pair.options;
  const std::vector<Match> matched = match(neighbours, options.matching);
  const MatchSet putative = pair.set(matched, MatchSet::Use::sizes);
  const MatchSet nearest = pair.set(all_nearest(neighbours), MatchSet::Use::sizes);
  Registration result;
  result.putative = putative.matches();
  const Hypothesis best = find_hypothesis(putative, nearest, options, pair.seed);
  if (!best.motion) {
    const auto is_placed = [&pair](const Match& match) {
      return pair.from.points[static_cast<std::size_t>(match.from)].allFinite() &&
             pair.to.points[static_cast<std::size_t>(match.to)].allFinite();
    };
    const auto placed = static_cast<std::size_t>(std::ranges::count_if(matched, is_placed));
    return refused(std::move(result), no_hypothesis(placed, putative.size(), options));
  }
  const Rivals rivals = pair.rivals(best, putative, nearest);
  result.evidence = weigh(best, rivals, nearest, options);
  const std::string reason = reason_to_refuse(result.evidence, options);
  if (!reason.empty()) {
    result.inliers = picked(nearest, best.support);
    return refused(std::move(result), reason);
  }
  return accepted(std::move(result), pair, fit_motion(*best.motion, nearest, options), nearest);
}

// With the lengths that may be in pixels in metres, which all steps below take them in.
RegistrationOptions in_metres(RegistrationOptions options, const Viewpoint& from,
                              const Viewpoint& to) {
  const double coarser_m = std::max(from.metres_per_pixel, to.metres_per_pixel);
  options.ransac.max_error_m = options.ransac.max_error_on_floor(coarser_m);
  CovarianceOptions& covariance = options.covariance;
  covariance.floor_sigma_m =
      covariance.floor_sigma_m.value_or(covariance.floor_sigma_px * coarser_m);
  if (!(*covariance.floor_sigma_m > 0.0)) {
    throw InputError(
        "covariance.floor_sigma_px: without pictures and their altitudes it is no distance; "
        "expected covariance.floor_sigma_m");
  }
  return options;
}

}  // namespace

Registration register_pair(const FloorFeatures& from, const FloorFeatures& to,
                           const RegistrationOptions& options, std::uint64_t seed) {
  require_points(from);
  require_points(to);
  const RegistrationOptions in_force = in_metres(options, from.viewpoint, to.viewpoint);
  const Pair pair{from, to, in_force, seed};
  if (options.decision.method == DecisionOptions::Method::inliers) {
    return by_inliers(pair, find_nearest(from.features, to.features));
  }
  if (auto refused = refused_at_first(pair)) return std::move(*refused);
  return by_false_alarms(pair, find_nearest(from.features, to.features));
}

}  // namespace fathom
