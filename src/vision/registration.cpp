#include "fathom/vision/registration.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

#include "fathom/vision/rigid_motion.hpp"

namespace fathom {
namespace {

const Eigen::Vector2d& point(const FloorFeatures& picture, int row) {
  return picture.points[static_cast<std::size_t>(row)];
}

// SIFT puts several keypoints with different orientations at one place, and those of one place
// match those of another one by one: the same evidence, twice. The nearest in descriptors is kept.
std::vector<Match> one_per_place(std::vector<Match> matches, const FloorFeatures& from,
                                 const FloorFeatures& to) {
  const auto place = [&](const Match& m) {
    const Eigen::Vector2d& p = point(from, m.from);
    const Eigen::Vector2d& q = point(to, m.to);
    return std::array{p.x(), p.y(), q.x(), q.y()};
  };
  // A point that is no number would match nothing, and cannot be ordered.
  std::erase_if(matches, [&](const Match& m) {
    return !point(from, m.from).allFinite() || !point(to, m.to).allFinite();
  });
  std::ranges::sort(matches, [&](const Match& a, const Match& b) {
    return std::tuple(place(a), a.distance, a.from) < std::tuple(place(b), b.distance, b.from);
  });
  const auto same_place = [&](const Match& a, const Match& b) { return place(a) == place(b); };
  matches.erase(std::unique(matches.begin(), matches.end(), same_place), matches.end());
  std::ranges::sort(matches, {}, &Match::from);
  return matches;
}

void require_points(const FloorFeatures& picture) {
  const std::size_t rows = static_cast<std::size_t>(picture.features.descriptors.rows);
  if (picture.points.size() != rows) {
    throw InputError("features need a point for each descriptor, got " +
                     std::to_string(picture.points.size()) + " and " + std::to_string(rows));
  }
}

struct Points {
  std::vector<Eigen::Vector2d> p;  // in `from`
  std::vector<Eigen::Vector2d> q;  // in `to`

  void add(const Match& match, const FloorFeatures& from, const FloorFeatures& to) {
    p.push_back(point(from, match.from));
    q.push_back(point(to, match.to));
  }
};

std::string why_not(const Consensus& consensus, std::size_t matches, const RansacOptions& options) {
  const std::string needed = std::to_string(options.min_inliers) + " are needed";
  if (static_cast<int>(matches) < options.min_inliers) {
    return std::to_string(matches) + " matches, " + needed;
  }
  const std::string agree =
      std::to_string(consensus.most_agreeing) + " of " + std::to_string(matches) + " matches agree";
  if (consensus.most_agreeing < options.min_inliers) return agree + ", " + needed;
  return agree + ", in " + std::to_string(consensus.most_places) + " places, " +
         std::to_string(options.min_places) + " are needed";
}

Eigen::Matrix3d floor_of(const CovarianceFloor& floor) {
  return Eigen::Vector3d(floor.sigma_m, floor.sigma_m, floor.sigma_rad)
      .array()
      .square()
      .matrix()
      .asDiagonal();
}

}  // namespace

void CovarianceFloor::describe(OptionTable& table) {
  table.real("sigma_m", sigma_m, Range::positive(), "m",
             "standard deviation added to a registration's x and y");
  table.real("sigma_rad", sigma_rad, Range::positive(), "rad",
             "standard deviation added to a registration's heading");
}

void RegistrationOptions::describe(OptionTable& table) {
  table.group("matching", matching);
  table.group("ransac", ransac);
  table.group("covariance_floor", covariance_floor);
}

Registration register_pair(const FloorFeatures& from, const FloorFeatures& to,
                           const RegistrationOptions& options, std::uint64_t seed) {
  require_points(from);
  require_points(to);
  Registration result;
  result.matches = one_per_place(match(from.features, to.features, options.matching), from, to);
  Points matched;
  for (const Match& m : result.matches) matched.add(m, from, to);

  Consensus consensus = ransac(matched.p, matched.q, options.ransac, seed);
  if (!consensus.motion) {
    result.reason = why_not(consensus, result.matches.size(), options.ransac);
    return result;
  }
  result.found = true;
  result.motion = *consensus.motion;
  result.inliers = std::move(consensus.inliers);
  result.rms_m = consensus.rms_m;

  Points agreeing;
  for (const int index : result.inliers) {
    agreeing.add(result.matches[static_cast<std::size_t>(index)], from, to);
  }
  result.covariance =
      motion_covariance(result.motion, agreeing.p, agreeing.q) + floor_of(options.covariance_floor);
  return result;
}

}  // namespace fathom
