#include "estimators/support/pose_graph/lifted_headings.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include <Eigen/Core>

#include "fathom/core/random.hpp"

namespace fathom::pose_graph {
namespace {

using Complex = std::complex<double>;
using Lifted = Eigen::Vector4d;  // (Re, Im) of both components of Y

Complex first_of(const Lifted& y) {
  return {y[0], y[1]};
}

Complex second_of(const Lifted& y) {
  return {y[2], y[3]};
}

// e^{iδ} Y.
Lifted turn(const Lifted& y, double c, double s) {
  return {c * y[0] - s * y[1], s * y[0] + c * y[1], c * y[2] - s * y[3], s * y[2] + c * y[3]};
}

// Orthonormal directions along the sphere: the quaternion units times Y.
Eigen::Matrix<double, 4, 3> tangents(const Lifted& y) {
  Eigen::Matrix<double, 4, 3> T;
  T << -y[1], -y[2], -y[3],  //
      y[0], y[3], -y[2],     //
      -y[3], y[0], y[1],     //
      y[2], -y[1], y[0];
  return T;
}

class LiftedProblem {
 public:
  LiftedProblem(const sparse::Symbolic& symbolic, std::span<const Edge> edges,
                std::span<const double> theta, const LiftedTuning& tuning)
      : tuning_(tuning),
        symbolic_(symbolic),
        factor_(symbolic),
        gradient_(3 * at(symbolic.size())) {
    for (const Edge& edge : edges) {
      terms_.push_back({edge.from, edge.to, heading_information(edge), std::cos(edge.theta),
                        std::sin(edge.theta)});
    }
    RandomStream noise(1, "lifted_headings");
    for (const double t : theta) {
      Lifted y(std::cos(t), std::sin(t), tuning.lift_noise * noise.normal(),
               tuning.lift_noise * noise.normal());
      Y_.push_back(y.normalized());
    }
    Y_[0] << std::cos(theta[0]), std::sin(theta[0]), 0.0, 0.0;
  }

  void minimise() {
    double damping = 0.0;
    double cost = cost_of(Y_);
    for (int step = 0; step < tuning_.max_steps; ++step) {
      if (!solve(damping)) return;
      std::vector<Lifted> trial = moved();
      const double next = cost_of(trial);
      if (!(next < cost)) {
        damping = std::max(tuning_.first_damping, 10.0 * damping);
        if (damping > tuning_.largest_damping) return;
        continue;
      }
      Y_.swap(trial);
      const double fallen = cost - next;
      cost = next;
      damping = damping > tuning_.first_damping ? 0.1 * damping : 0.0;
      if (fallen <= tuning_.tolerance * cost && damping == 0.0) return;
    }
  }

  // The angles along the first eigenvector of Σ Y Yᴴ = [p q; q* r], turned so that keyframe 0 has
  // its own.
  std::vector<double> headings(double first_rad) const {
    double p = 0.0;
    double r = 0.0;
    Complex q = 0.0;
    for (const Lifted& y : Y_) {
      p += std::norm(first_of(y));
      r += std::norm(second_of(y));
      q += first_of(y) * std::conj(second_of(y));
    }
    const double largest = 0.5 * (p + r) + std::hypot(0.5 * (p - r), std::abs(q));
    const Complex u_first = p >= r ? Complex(largest - r) : q;
    const Complex u_second = p >= r ? std::conj(q) : Complex(largest - p);
    std::vector<double> theta;
    for (const Lifted& y : Y_) {
      theta.push_back(
          std::arg(std::conj(u_first) * first_of(y) + std::conj(u_second) * second_of(y)));
    }
    const double shift = first_rad - theta[0];
    for (double& t : theta) t += shift;
    return theta;
  }

 private:
  struct Term {
    int from = 0;
    int to = 0;
    double w = 0.0;
    double c = 1.0;
    double s = 0.0;
  };

  double cost_of(const std::vector<Lifted>& Y) const {
    double sum = 0.0;
    for (const Term& t : terms_) {
      sum += t.w * (Y[at(t.to)] - turn(Y[at(t.from)], t.c, t.s)).squaredNorm();
    }
    return sum;
  }

  // Newton's step on the sphere; Gauss-Newton's where that matrix is not positive definite.
  bool solve(double damping) {
    for (const double curvature : {1.0, 0.0}) {
      add_up(curvature, damping);
      if (!factor_.factorise() || factor_.negative_pivots() > 0) continue;
      factor_.solve(gradient_.data());
      return true;
    }
    return false;
  }

  void add_up(double curvature, double damping) {
    factor_.clear();
    std::fill(gradient_.begin(), gradient_.end(), 0.0);
    const auto add_diagonal = [&](int k, double value) {
      if (k == 0) return;
      const sparse::BlockPlace place = factor_.place(k - 1, k - 1);
      for (int a = 0; a < 3; ++a) {
        factor_.data()[place.offset + at(a * (place.stride + 1))] += value;
      }
    };
    const auto add_gradient = [&](int k, const Lifted& value) {
      if (k == 0) return;
      Eigen::Map<Eigen::Vector3d> g(gradient_.data() + 3 * at(symbolic_.position[at(k - 1)]));
      g += tangents(Y_[at(k)]).transpose() * value;
    };
    for (const Term& t : terms_) {
      const Lifted& i = Y_[at(t.from)];
      const Lifted& k = Y_[at(t.to)];
      const double diagonal =
          t.w * (1.0 + damping) - curvature * t.w * (1.0 - k.dot(turn(i, t.c, t.s)));
      add_diagonal(t.from, diagonal);
      add_diagonal(t.to, diagonal);
      add_gradient(t.to, t.w * turn(i, t.c, t.s));
      add_gradient(t.from, t.w * turn(k, t.c, -t.s));
      if (t.from == 0 || t.to == 0) continue;
      const bool to_is_row = symbolic_.position[at(t.to - 1)] > symbolic_.position[at(t.from - 1)];
      const auto T_row = tangents(to_is_row ? k : i);
      const auto T_column = tangents(to_is_row ? i : k);
      const double s = to_is_row ? t.s : -t.s;
      const sparse::BlockPlace place = factor_.place(t.from - 1, t.to - 1);
      for (int b = 0; b < 3; ++b) {
        const Lifted turned = turn(T_column.col(b), t.c, s);
        double* to = factor_.data() + place.offset + at(b * place.stride);
        for (int a = 0; a < 3; ++a) to[a] -= t.w * T_row.col(a).dot(turned);
      }
    }
  }

  std::vector<Lifted> moved() const {
    std::vector<Lifted> result = Y_;
    for (std::size_t k = 1; k < Y_.size(); ++k) {
      const Eigen::Map<const Eigen::Vector3d> step(gradient_.data() +
                                                   3 * at(symbolic_.position[k - 1]));
      result[k] = (Y_[k] + tangents(Y_[k]) * step).normalized();
    }
    return result;
  }

  LiftedTuning tuning_;
  const sparse::Symbolic& symbolic_;
  sparse::BlockCholesky<3> factor_;
  std::vector<Term> terms_;
  std::vector<Lifted> Y_;
  std::vector<double> gradient_;  ///< downhill, then the step
};

}  // namespace

std::vector<double> lifted_headings(const sparse::Symbolic& symbolic, std::span<const Edge> edges,
                                    std::span<const double> theta, const LiftedTuning& tuning) {
  LiftedProblem problem(symbolic, edges, theta, tuning);
  problem.minimise();
  return problem.headings(theta[0]);
}

}  // namespace fathom::pose_graph
