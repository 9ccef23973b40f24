#include "point_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>

#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

double square(double x) {
  return x * x;
}

struct Rigid {
  explicit Rigid(const Pose& z) : x(z.x), y(z.y), c(std::cos(z.theta)), s(std::sin(z.theta)) {}

  double squared_error(double px, double py, double qx, double qy) const {
    const double ex = px - x - (c * qx - s * qy);
    const double ey = py - y - (s * qx + c * qy);
    return ex * ex + ey * ey;
  }

  // Whether it turns by an angle of this cosine and sine, to within one of cosine `least`.
  bool turns_so(double cosine, double sine, double least) const {
    return c * cosine + s * sine >= least;
  }

  double x, y, c, s;
};

}  // namespace

PointPairs::PointPairs(std::span<const Eigen::Vector2d> p, std::span<const Eigen::Vector2d> q) {
  if (p.size() != q.size()) {
    throw InputError(
        fmt::format("matched points must come in pairs, got {} and {}", p.size(), q.size()));
  }
  for (std::size_t j = 0; j < p.size(); ++j) {
    px_.push_back(p[j].x());
    py_.push_back(p[j].y());
    qx_.push_back(q[j].x());
    qy_.push_back(q[j].y());
  }
}

PointPairs::PointPairs(std::span<const Eigen::Vector2d> p, std::span<const Eigen::Vector2d> q,
                       std::span<const double> turns_rad, double turn_tolerance_rad)
    : PointPairs(p, q) {
  least_turn_cosine_ = std::cos(turn_tolerance_rad);
  for (const double turn : turns_rad) {
    turn_cosine_.push_back(std::cos(turn));
    turn_sine_.push_back(std::sin(turn));
  }
}

Eigen::Vector2d PointPairs::p(int index) const {
  const std::size_t j = static_cast<std::size_t>(index);
  return {px_[j], py_[j]};
}

Eigen::Vector2d PointPairs::q(int index) const {
  const std::size_t j = static_cast<std::size_t>(index);
  return {qx_[j], qy_[j]};
}

PointPairs PointPairs::turning(double theta_rad) const {
  if (turn_cosine_.empty()) return *this;
  const Rigid motion({0.0, 0.0, theta_rad});
  PointPairs kept({}, {});
  for (std::size_t j = 0; j < px_.size(); ++j) {
    if (!motion.turns_so(turn_cosine_[j], turn_sine_[j], least_turn_cosine_)) continue;
    kept.px_.push_back(px_[j]);
    kept.py_.push_back(py_[j]);
    kept.qx_.push_back(qx_[j]);
    kept.qy_.push_back(qy_[j]);
  }
  return kept;
}

bool PointPairs::fit_together(int a, int b, double max_error_m) const {
  return std::abs((p(a) - p(b)).norm() - (q(a) - q(b)).norm()) <= 2.0 * max_error_m;
}

int PointPairs::count_inliers(const Pose& z, double max_error_m) const {
  const Rigid motion(z);
  const double limit = max_error_m * max_error_m;
  const double* px = px_.data();
  const double* py = py_.data();
  const double* qx = qx_.data();
  const double* qy = qy_.data();
  int count = 0;
  if (turn_cosine_.empty()) {
    for (std::size_t j = 0; j < px_.size(); ++j) {
      count += motion.squared_error(px[j], py[j], qx[j], qy[j]) <= limit ? 1 : 0;
    }
    return count;
  }
  const double* cosine = turn_cosine_.data();
  const double* sine = turn_sine_.data();
  const double least = least_turn_cosine_;
  for (std::size_t j = 0; j < px_.size(); ++j) {
    const bool is_near = motion.squared_error(px[j], py[j], qx[j], qy[j]) <= limit;
    const bool turns_so = motion.turns_so(cosine[j], sine[j], least);
    count += (is_near & turns_so) ? 1 : 0;
  }
  return count;
}

std::vector<int> PointPairs::inliers(const Pose& z, double max_error_m) const {
  const Rigid motion(z);
  const double limit = max_error_m * max_error_m;
  std::vector<int> indices;
  for (std::size_t j = 0; j < px_.size(); ++j) {
    if (motion.squared_error(px_[j], py_[j], qx_[j], qy_[j]) <= limit &&
        (turn_cosine_.empty() ||
         motion.turns_so(turn_cosine_[j], turn_sine_[j], least_turn_cosine_))) {
      indices.push_back(static_cast<int>(j));
    }
  }
  return indices;
}

int PointPairs::count_places(const std::vector<int>& indices, double radius_m, int enough) const {
  const double limit = radius_m * radius_m;
  std::vector<double> px, py, qx, qy;  // of the places
  for (const int index : indices) {
    const std::size_t count = px.size();
    if (static_cast<int>(count) >= enough) break;
    const Eigen::Vector2d p_new = p(index);
    const Eigen::Vector2d q_new = q(index);
    // Without a branch, which makes vector instructions of it: faster than to stop at the first.
    int near = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double in_from = square(p_new.x() - px[k]) + square(p_new.y() - py[k]);
      const double in_to = square(q_new.x() - qx[k]) + square(q_new.y() - qy[k]);
      near += std::min(in_from, in_to) <= limit ? 1 : 0;
    }
    if (near > 0) continue;
    px.push_back(p_new.x());
    py.push_back(p_new.y());
    qx.push_back(q_new.x());
    qy.push_back(q_new.y());
  }
  return static_cast<int>(px.size());
}

}  // namespace fathom
