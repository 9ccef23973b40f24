#include "fathom/measurements/connected_guess.hpp"

#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <queue>
#include <utility>

#include <Eigen/LU>

namespace fathom {
namespace {

// One absolute measurement of a keyframe with its pose so far; information in world axes.
struct Pairing {
  Pose at;
  Pose measured;
  Eigen::Matrix2d position_information;
  double heading_information = 0.0;
};

Pairing pairing_of(const AbsolutePose& z, const Pose& at) {
  Pairing pairing;
  pairing.at = at;
  pairing.measured = z.pose;
  const Eigen::Matrix2d R = rotation(z.pose.theta);
  const Eigen::Matrix2d own = z.information.topLeftCorner<2, 2>();
  pairing.position_information = R * own * R.transpose();
  // The position left free; of one that is not measured nothing is lost.
  const Eigen::Vector2d cross = z.information.topRightCorner<2, 1>();
  const Eigen::FullPivLU<Eigen::Matrix2d> lu(own);
  const double lost = lu.isInvertible() ? cross.dot(lu.solve(cross)) : 0.0;
  const double left = z.information(2, 2) - lost;
  pairing.heading_information = left > 1e-9 * z.information(2, 2) ? left : 0.0;
  return pairing;
}

// The heading by which the poses are turned; 0 where nothing says one.
double turn_of(const std::vector<Pairing>& pairings) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Pairing& p : pairings) {
    const double turn = p.measured.theta - p.at.theta;
    sum += p.heading_information * Eigen::Vector2d(std::cos(turn), std::sin(turn));
  }
  if (!sum.isZero()) return std::atan2(sum.y(), sum.x());
  // Of positions about their means (Horn 1987, in the plane).
  double total = 0.0;
  Eigen::Vector2d mean_at = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_measured = Eigen::Vector2d::Zero();
  for (const Pairing& p : pairings) {
    const double w = p.position_information.trace();
    total += w;
    mean_at += w * p.at.position();
    mean_measured += w * p.measured.position();
  }
  if (total == 0.0) return 0.0;
  mean_at /= total;
  mean_measured /= total;
  double dot = 0.0;
  double cross = 0.0;
  for (const Pairing& p : pairings) {
    const double w = p.position_information.trace();
    const Eigen::Vector2d a = p.at.position() - mean_at;
    const Eigen::Vector2d b = p.measured.position() - mean_measured;
    dot += w * a.dot(b);
    cross += w * (a.x() * b.y() - a.y() * b.x());
  }
  return std::atan2(cross, dot);
}

// Stretches of keyframes without a hole, each with a place once it has one.
class Stretches {
 public:
  explicit Stretches(const MeasurementLog& log) : log_(log), own_(log.odometry()) {
    for (std::size_t k = 0; k < log.size(); ++k) {
      if (k == 0 || log.arrival(k).step.is_hole) members_.emplace_back();
      members_.back().push_back(k);
      of_.push_back(members_.size() - 1);
    }
    is_placed_.assign(members_.size(), 0);
    is_placed_[0] = 1;
    between_.resize(members_.size());
    for (std::size_t k = 1; k < log.size(); ++k) {
      for (const RelativePose& z : log.arrival(k).registrations) {
        if (of_[z.from] == of_[z.to]) continue;
        between_[of_[z.from]].push_back(registrations_.size());
        between_[of_[z.to]].push_back(registrations_.size());
        registrations_.push_back(&z);
      }
    }
  }

  void place_all() {
    place_by_registrations(0);
    for (std::size_t s = 1; s < members_.size(); ++s) {
      if (is_placed_[s] != 0) continue;
      place_by_the_world(s);
      place_by_registrations(s);
    }
  }

  std::vector<Pose> poses() && { return std::move(own_); }

 private:
  // The whole stretch, so that keyframe k comes to stand at `pose`.
  void move(std::size_t stretch, std::size_t k, const Pose& pose) {
    const Pose motion = compose(pose, inverse(own_[k]));
    for (const std::size_t m : members_[stretch]) own_[m] = compose(motion, own_[m]);
    is_placed_[stretch] = 1;
  }

  // In the order of passes over all registrations until a pass places nothing; each is looked at
  // only after one of its stretches came to have a place.
  void place_by_registrations(std::size_t placed) {
    using Turn = std::pair<std::size_t, std::size_t>;  // the pass, the registration
    std::priority_queue<Turn, std::vector<Turn>, std::greater<>> turns;
    for (const std::size_t r : between_[placed]) turns.emplace(0, r);
    while (!turns.empty()) {
      const Turn now = turns.top();
      turns.pop();
      const auto stretch = place_by(registrations_[now.second]->forward());
      if (!stretch) continue;
      for (const std::size_t r : between_[*stretch]) {
        turns.emplace(r > now.second ? now.first : now.first + 1, r);
      }
    }
  }

  // The stretch that it gives a place, if it is of one with a place and one without.
  std::optional<std::size_t> place_by(const RelativePose& z) {
    const std::size_t a = of_[z.from];
    const std::size_t b = of_[z.to];
    if (is_placed_[a] == is_placed_[b]) return std::nullopt;
    if (is_placed_[a] != 0) {
      move(b, z.to, compose(own_[z.from], z.motion));
      return b;
    }
    move(a, z.from, compose(own_[z.to], inverse(z.motion)));
    return a;
  }

  // By the guess over the hole, then nearer to what is measured of it.
  void place_by_the_world(std::size_t stretch) {
    const std::size_t first = members_[stretch].front();
    move(stretch, first, compose(own_[first - 1], log_.arrival(first).step.forward().motion));
    std::vector<Pose> poses;
    for (const std::size_t k : members_[stretch]) poses.push_back(own_[k]);
    const Pose motion = rigid_fit(log_, members_[stretch], poses);
    move(stretch, first, compose(motion, own_[first]));
  }

  const MeasurementLog& log_;
  std::vector<Pose> own_;
  std::vector<std::vector<std::size_t>> members_;
  std::vector<std::size_t> of_;  ///< stretch of each keyframe
  std::vector<char> is_placed_;
  std::vector<const RelativePose*> registrations_;  ///< of two stretches, as they arrive
  std::vector<std::vector<std::size_t>> between_;   ///< of them, those of each stretch
};

}  // namespace

Pose rigid_fit(const MeasurementLog& log, std::span<const std::size_t> keyframes,
               std::span<const Pose> poses) {
  std::vector<Pairing> pairings;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    for (const AbsolutePose& z : log.arrival(keyframes[i]).absolute) {
      pairings.push_back(pairing_of(z, poses[i]));
    }
  }
  const double turn = turn_of(pairings);
  const Eigen::Matrix2d R = rotation(turn);
  // About the first pose, which stays where nothing says a position.
  Eigen::Vector2d shift = poses.front().position() - R * poses.front().position();
  Eigen::Matrix2d W = Eigen::Matrix2d::Zero();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Pairing& p : pairings) {
    W += p.position_information;
    sum += p.position_information * (p.measured.position() - R * p.at.position() - shift);
  }
  if (W.determinant() > 0.0) shift += W.inverse() * sum;
  return {shift.x(), shift.y(), turn};
}

std::vector<Pose> connected_guess(const MeasurementLog& log) {
  Stretches stretches(log);
  stretches.place_all();
  std::vector<Pose> poses = std::move(stretches).poses();
  if (!log.start().is_free) return poses;
  std::vector<std::size_t> keyframes(log.size());
  std::iota(keyframes.begin(), keyframes.end(), std::size_t{0});
  const Pose motion = rigid_fit(log, keyframes, poses);
  for (Pose& pose : poses) pose = compose(motion, pose);
  return poses;
}

}  // namespace fathom
