#include "motion_bends.hpp"

#include "point_shifts.hpp"

namespace fathom {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Eigen::Vector2d turned(const Eigen::Vector2d& a) {
  return {-a.y(), a.x()};
}

// Weighted sums over the points, which lie at Q from the origin of `to` in axes of `from`, of how
// tilts of one picture move them: by roll and pitch, and by roll², pitch² and roll pitch.
struct Sums {
  double spread = 0.0;                              // Σ w ‖Q̃‖², Q̃ from the mean
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();   // of Q
  Eigen::Matrix2d first = Eigen::Matrix2d::Zero();  // means of the shifts
  Eigen::Matrix<double, 2, 3> second = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Vector2d turn = Eigen::Vector2d::Zero();     // Σ w Q̃ × shift
  Eigen::Vector2d stretch = Eigen::Vector2d::Zero();  // Σ w Q̃ · shift
  Eigen::Vector3d second_turn = Eigen::Vector3d::Zero();
};

// The second derivative of z by n_i and n_j, which is column `both` of the second shifts. The fit
// is θ = atan2(s, c), s = Σ w q̃ × p̃, c = Σ w q̃ · p̃, and t = p̄ − Rot(θ) q̄ (the paper's equations 1
// to 3); at the fit s = 0, c = spread. Shifts of q turn the other way, and are turned with q.
Eigen::Vector3d second_of_motion(const Sums& sums, bool is_from, int i, int j, int both) {
  const double sign = is_from ? 1.0 : -1.0;
  const double theta_i = sign * sums.turn[i] / sums.spread;
  const double theta_j = sign * sums.turn[j] / sums.spread;
  const double theta_ij =
      (sign * sums.second_turn[both] - theta_i * sums.stretch[j] - theta_j * sums.stretch[i]) /
      sums.spread;
  Eigen::Vector2d t =
      sign * sums.second.col(both) - theta_ij * turned(sums.mean) + theta_i * theta_j * sums.mean;
  if (!is_from) t -= theta_i * turned(sums.first.col(j)) + theta_j * turned(sums.first.col(i));
  return {t.x(), t.y(), theta_ij};
}

Eigen::Matrix3d bend(const Sums& sums, bool is_from) {
  const Eigen::Vector3d rr = second_of_motion(sums, is_from, 0, 0, 0);
  const Eigen::Vector3d pp = second_of_motion(sums, is_from, 1, 1, 1);
  const Eigen::Vector3d rp = second_of_motion(sums, is_from, 0, 1, 2);
  // E b bᵀ of b = ½ (rr r² + pp p²) + rp r p, r and p standard normal.
  const Eigen::Vector3d mean = 0.5 * (rr + pp);
  return mean * mean.transpose() + 0.5 * (rr * rr.transpose() + pp * pp.transpose()) +
         rp * rp.transpose();
}

}  // namespace

std::pair<Eigen::Matrix3d, Eigen::Matrix3d> motion_bends(const Pose& z,
                                                         std::span<const Eigen::Vector2d> q,
                                                         std::span<const double> weights,
                                                         const Viewpoint& from,
                                                         const Viewpoint& to) {
  if (!(from.altitude_m > 0.0) || !(to.altitude_m > 0.0)) {
    return {Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
  }
  const Eigen::Matrix2d R = rotation(z.theta);
  Sums of_from;
  double total = 0.0;
  for (std::size_t j = 0; j < q.size(); ++j) {
    of_from.mean += weights[j] * (R * q[j]);
    total += weights[j];
  }
  of_from.mean /= total;
  Sums of_to = of_from;
  for (std::size_t j = 0; j < q.size(); ++j) {
    const Eigen::Vector2d off = R * q[j] - of_from.mean;
    const auto add = [&](Sums& sums, const Eigen::Matrix2d& first,
                         const Eigen::Matrix<double, 2, 3>& second) {
      sums.spread += weights[j] * off.squaredNorm();
      sums.first += weights[j] / total * first;
      sums.second += weights[j] / total * second;
      for (int i = 0; i < 2; ++i) {
        sums.turn[i] += weights[j] * cross(off, first.col(i));
        sums.stretch[i] += weights[j] * off.dot(first.col(i));
      }
      for (int i = 0; i < 3; ++i) sums.second_turn[i] += weights[j] * cross(off, second.col(i));
    };
    const Eigen::Vector2d p = transform(z, q[j]);
    add(of_from, shift_by_errors(from, p).rightCols<2>(), shift_by_tilts(from, p));
    add(of_to, R * shift_by_errors(to, q[j]).rightCols<2>(), R * shift_by_tilts(to, q[j]));
  }
  return {bend(of_from, true), bend(of_to, false)};
}

}  // namespace fathom
