// F of a log whose registrations share errors: least squares in these, at a trajectory.

#include <cstddef>
#include <vector>

#include <Eigen/SparseCholesky>

#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom {
namespace {

// One registration with its errors apart; n in units of σ.
struct Told {
  Eigen::Index from = 0;  // first row of n
  Eigen::Index to = 0;
  Eigen::Matrix3d G_from;
  Eigen::Matrix3d G_to;
  Eigen::Matrix3d W;   // own⁻¹
  Eigen::Vector3d nu;  // z − h(x)
};

class SharedLeastSquares {
 public:
  explicit SharedLeastSquares(std::size_t keyframes) : row_of_(keyframes, -1) {}

  /// One that is told.
  void add(const RelativePose& z, std::span<const Pose> trajectory, double weight) {
    Told told;
    told.from = row_of(z.from);
    told.to = row_of(z.to);
    told.G_from = z.shared->from.scaled();
    told.G_to = z.shared->to.scaled();
    told.W = symmetric_inverse(z.shared->own);
    told.nu = -(planar_rotation(z.motion.theta) *
                residual(z.motion, trajectory[z.from], trajectory[z.to]));
    const Eigen::Matrix3d W = weight * told.W;
    add_block(told.from, told.from, told.G_from.transpose() * W * told.G_from);
    add_block(told.to, told.to, told.G_to.transpose() * W * told.G_to);
    const Eigen::Matrix3d cross = told.G_from.transpose() * W * told.G_to;
    add_block(told.from, told.to, cross);
    add_block(told.to, told.from, cross.transpose());
    add_gradient(told.from, told.G_from.transpose() * W * told.nu);
    add_gradient(told.to, told.G_to.transpose() * W * told.nu);
    told_.push_back(told);
  }

  /// Of each that was added, in order: the own error that n at the minimum leaves it.
  std::vector<Eigen::Vector3d> own_errors() {
    solve();
    std::vector<Eigen::Vector3d> errors;
    for (const Told& z : told_) errors.push_back(own_error(z));
    return errors;
  }

  double minimum(const std::function<double(double)>& loss) {
    solve();
    double sum = n_.squaredNorm();
    for (const Told& z : told_) {
      const Eigen::Vector3d own = own_error(z);
      sum += loss(own.dot(z.W * own));
    }
    return sum;
  }

 private:
  void solve() {
    Eigen::SparseMatrix<double> A(rows_, rows_);
    A.setFromTriplets(elements_.begin(), elements_.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(A);
    n_ = factor.solve(Eigen::Map<const Eigen::VectorXd>(
        gradient_.data(), static_cast<Eigen::Index>(gradient_.size())));
  }

  Eigen::Vector3d own_error(const Told& z) const {
    return z.nu - z.G_from * n_.segment<3>(z.from) - z.G_to * n_.segment<3>(z.to);
  }

  // The prior of n is the identity.
  Eigen::Index row_of(std::size_t k) {
    if (row_of_[k] < 0) {
      row_of_[k] = rows_;
      rows_ += 3;
      gradient_.resize(static_cast<std::size_t>(rows_), 0.0);
      add_block(row_of_[k], row_of_[k], Eigen::Matrix3d::Identity());
    }
    return row_of_[k];
  }

  void add_block(Eigen::Index row, Eigen::Index column, const Eigen::Matrix3d& block) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) elements_.emplace_back(row + i, column + j, block(i, j));
    }
  }

  void add_gradient(Eigen::Index row, const Eigen::Vector3d& g) {
    for (int i = 0; i < 3; ++i) gradient_[static_cast<std::size_t>(row + i)] += g[i];
  }

  std::vector<Eigen::Index> row_of_;
  Eigen::Index rows_ = 0;
  std::vector<Told> told_;
  std::vector<Eigen::Triplet<double>> elements_;
  std::vector<double> gradient_;
  Eigen::VectorXd n_;
};

}  // namespace

double shared_chi2_used(const MeasurementLog& log, std::span<const Pose> trajectory,
                        std::span<const double> weights,
                        const std::function<double(double)>& loss) {
  double sum = 0.0;
  SharedLeastSquares shared(log.size());
  std::size_t registration = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    const auto chi2_of = [&](const RelativePose& z) {
      return chi2(z, trajectory[z.from], trajectory[z.to]);
    };
    if (!arrival.step.is_hole) sum += chi2_of(arrival.step);
    for (const RelativePose& z : arrival.registrations) {
      const double weight = weights.empty() ? 1.0 : weights[registration];
      ++registration;
      if (weight == 0.0) continue;
      if (z.shared) {
        shared.add(z, trajectory, weight);
      } else {
        sum += loss(chi2_of(z));
      }
    }
  }
  return sum + shared.minimum(loss);
}

double shared_chi2(const MeasurementLog& log, std::span<const Pose> trajectory) {
  if (!log.tells_shared_errors()) return chi2(log, trajectory);
  return absolute_chi2(log, trajectory) +
         shared_chi2_used(log, trajectory, {}, [](double value) { return value; });
}

std::vector<Eigen::Vector3d> own_errors(const MeasurementLog& log,
                                        std::span<const Pose> trajectory) {
  SharedLeastSquares shared(log.size());
  for (std::size_t k = 1; k < log.size(); ++k) {
    for (const RelativePose& z : log.arrival(k).registrations) {
      if (z.shared) shared.add(z, trajectory, 1.0);
    }
  }
  return shared.own_errors();
}

double chi2(const MeasurementLog& log, std::span<const Pose> trajectory,
            RegistrationErrors errors) {
  return errors == RegistrationErrors::shared ? shared_chi2(log, trajectory)
                                              : chi2(log, trajectory);
}

double chi2_alone(const MeasurementLog& log, std::span<const Pose> trajectory,
                  RegistrationErrors errors) {
  return chi2(with_registrations(log, [](const RelativePose& z, std::size_t) { return z.alone(); }),
              trajectory, errors);
}

}  // namespace fathom
