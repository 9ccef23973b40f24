#include "fathom/vision/registration.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <cstddef>
#include <tuple>
#include <utility>

#include <Eigen/Dense>
#include "fathom/core/chi_squared.hpp"
#include "fathom/vision/rigid_motion.hpp"
#include "motion_search.hpp"

namespace fathom {
namespace {

const Eigen::Vector2d& point(const FloorFeatures& picture, int row) {
  return picture.points[static_cast<std::size_t>(row)];
}

// SIFT puts several keypoints with different orientations at one place, and those of one place
// match those of another one by one: the same evidence, twice. The nearest in descriptors is kept.
[[maybe_unused]] std::vector<Match> one_per_place(std::vector<Match> matches, const FloorFeatures& from,
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

[[maybe_unused]] std::string why_not(const Consensus& consensus, std::size_t matches, const RansacOptions& options) {
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

struct Refined {
  Pose motion;
  std::vector<int> inliers;
  Eigen::Matrix3d covariance;
};

struct Weighted {
  Pose z;
  Eigen::Matrix3d information;  // J^T W J
};

Pose weighted_motion(const MatchSet& set, const std::vector<int>& in) {
  Eigen::Vector2d pm = Eigen::Vector2d::Zero(), qm = pm;
  double sum = 0;
  for (int i : in) {
    const double w = 1 / set.relative_variance(i);
    pm += w * set.pairs().p(i);
    qm += w * set.pairs().q(i);
    sum += w;
  }
  pm /= sum;
  qm /= sum;
  double c = 0, s = 0;
  for (int i : in) {
    const double w = 1 / set.relative_variance(i);
    const Eigen::Vector2d a = set.pairs().p(i) - pm, b = set.pairs().q(i) - qm;
    c += w * a.dot(b);
    s += w * (b.x() * a.y() - b.y() * a.x());
  }
  const double theta = std::atan2(s, c);
  const Eigen::Vector2d t = pm - rotation(theta) * qm;
  return {t.x(), t.y(), theta};
}

Refined refine(Pose z, const MatchSet& set, double max_error_m) {
  Refined r;
  r.motion = z;
  std::vector<int> in = set.pairs().agreeing(z, max_error_m);
  double sigma2 = 0;
  for (int round = 0; round < 10; ++round) {
    std::vector<double> e;
    for (int i : in)
      e.push_back((set.pairs().p(i) - transform(r.motion, set.pairs().q(i))).squaredNorm() /
                  set.relative_variance(i));
    std::vector<double> sorted = e;
    std::ranges::sort(sorted);
    // median of a chi2 with two degrees of freedom: 2 ln 2
    sigma2 = sorted[sorted.size() / 2] / (2 * std::log(2.0));
    static const double gate = getenv("GATE") ? atof(getenv("GATE")) : 11.0;
    std::vector<int> kept;
    for (std::size_t k = 0; k < in.size(); ++k)
      if (e[k] <= gate * sigma2) kept.push_back(in[k]);
    if (kept.size() < 3) kept = in;
    r.motion = weighted_motion(set, kept);
    const bool same = kept == r.inliers;
    r.inliers = kept;
    if (same) break;
    in = set.pairs().agreeing(r.motion, max_error_m);
  }
  Eigen::Matrix3d info = Eigen::Matrix3d::Zero();
  double rss = 0;
  for (int i : r.inliers) {
    const double w = 1 / set.relative_variance(i);
    const Eigen::Vector2d turned = rotation(r.motion.theta) * set.pairs().q(i);
    Eigen::Matrix<double, 2, 3> J;
    J << 1, 0, -turned.y(), 0, 1, turned.x();
    info += w * J.transpose() * J;
    rss += w * (set.pairs().p(i) - transform(r.motion, set.pairs().q(i))).squaredNorm();
  }
  r.covariance = info.inverse() * rss / (2.0 * double(r.inliers.size()) - 3.0);
  static const double cell = getenv("CELL") ? atof(getenv("CELL")) : 0.2;
  if (cell > 0) {
    std::map<std::pair<int, int>, Eigen::Vector3d> scores;
    for (int i : r.inliers) {
      const Eigen::Vector2d q = set.pairs().q(i);
      const Eigen::Vector2d turned = rotation(r.motion.theta) * q;
      Eigen::Matrix<double, 2, 3> J;
      J << 1, 0, -turned.y(), 0, 1, turned.x();
      auto& g = scores.try_emplace({int(std::floor(q.x() / cell)), int(std::floor(q.y() / cell))},
                                   Eigen::Vector3d::Zero()).first->second;
      g += J.transpose() * (set.pairs().p(i) - transform(r.motion, q)) / set.relative_variance(i);
    }
    Eigen::Matrix3d meat = Eigen::Matrix3d::Zero();
    for (auto& [k, g] : scores) meat += g * g.transpose();
    const double C = double(scores.size());
    const Eigen::Matrix3d bread = info.inverse();
    const Eigen::Matrix3d robust = bread * meat * bread * (C / std::max(C - 1.5, 1.0));
    const double phi = (r.covariance.inverse() * robust).trace() / 3;
    if (getenv("PHI")) printf(" phi %.2f C %.0f n %zu;", phi, C, r.inliers.size());
    r.covariance *= std::max(1.0, phi);
  }
  return r;
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
  const NearestRows rows = find_nearest(from.features, to.features);
  const MatchSet distinct(match(rows, options.matching), from, to);
  const MatchSet nearest(all_nearest(rows), from, to);
  const SupportedMotion best = find_supported_motion(distinct, nearest, options.ransac, seed);
  result.matches = distinct.matches();
  result.nearest = static_cast<int>(nearest.size());
  if (!best.motion) return result;
  const SupportedMotion rival = find_rival(best, distinct, nearest, options.ransac, seed);
  result.support = static_cast<int>(best.supporters.size());
  result.places = best.places;
  result.rival = static_cast<int>(rival.supporters.size());
  result.rival_places = rival.places;
  const double e = options.ransac.max_error_m;
  const double fine = e / 3;
  const int elsewhere = most_places_elsewhere(best, nearest, 3 * e, e);
  const int elsewhere_fine = most_places_elsewhere(best, nearest, 3 * e, fine);
  const int fine_places = nearest.pairs().count_places(nearest.pairs().agreeing(*best.motion, fine), fine, 100000);
  result.e = elsewhere;
  result.ef = elsewhere_fine;
  result.fp = fine_places;
  const auto fa = [](int k, int r) {
    return std::log10(chi_squared_cdf(2.0 * std::max(r, 2), 2.0 * k) + 1e-300);
  };
  result.log10_false_alarms = std::min(fa(best.places, std::max(rival.places, elsewhere)),
                                       fa(fine_places, elsewhere_fine));
  static const double limit = getenv("NFA") ? atof(getenv("NFA")) : -9;
  if (result.log10_false_alarms > limit) return result;
  Refined refined = refine(*best.motion, nearest, options.ransac.max_error_m);
  result.found = true;
  result.motion = refined.motion;
  result.matches = nearest.matches();
  result.inliers = refined.inliers;
  result.covariance = refined.covariance + floor_of(options.covariance_floor);
  return result;
}

}  // namespace fathom
