#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fathom/measurements/variance_components.hpp"
#include "joint_rows.hpp"
#include "normal_factor.hpp"

namespace fathom {

/// The deviance −2ℓ of one choice of σ, and what else the search for the best one needs.
struct RestrictedFit {
  double deviance = 0.0;
  double chi2 = 0.0;
  Eigen::VectorXd y;            ///< the poses' steps and n
  Eigen::VectorXd slope;        ///< of the deviance by log σ
  Eigen::MatrixXd information;  ///< average information (Gilmour, Thompson and Cullis 1995)
};

/// −2ℓ of a linearised log as a function of the components' log σ. One symbolic analysis serves all
/// evaluations. Registrations' own errors are no unknowns: they scale rows by √w, w = 1/(1 + σ²).
/// docs/variance_components.md derives the formulas.
class RestrictedLikelihood {
 public:
  using Index = Eigen::Index;

  RestrictedLikelihood(const MeasurementLog& log, std::span<const Pose> trajectory,
                       std::span<const VarianceComponent> components,
                       const std::vector<bool>& used);

  /// A log σ that is NaN stands for what is told. Not finite where it cannot be had.
  double deviance(const Eigen::VectorXd& log_sigma);
  /// With derivatives.
  RestrictedFit fit(const Eigen::VectorXd& log_sigma);

  /// By registration, what VarianceEstimate::left_out_chi2 says.
  std::vector<double> left_out_chi2(const Eigen::VectorXd& log_sigma);

  const JointRows& rows() const { return rows_; }
  Index components() const { return static_cast<Index>(governed_.size()); }
  std::size_t pictures(Index component) const;
  /// The σ up to which a component does nothing: n of it has a thousandth of the standard deviation
  /// with which its registrations alone could say it. Infinite where they do not respond to it.
  double negligible(Index component) const;
  /// A typical σ of those told of a component.
  double told(Index component) const;
  double degrees_of_freedom() const;  ///< N − p

 private:
  // An element of n that a component governs.
  struct Governed {
    Index row;
    double told;
  };
  // Of all rows, Bᵀ W c = rest + w own.
  struct Parts {
    Eigen::VectorXd rest;
    Eigen::VectorXd own;
  };

  void govern(const VarianceComponent& component, std::size_t keyframes);
  void set_scales(const Eigen::VectorXd& log_sigma);
  bool factorise(const Eigen::VectorXd& log_sigma);
  void minimise();
  double own_count() const { return is_own_row_.sum(); }
  double own_squared_norm() const { return is_own_row_.dot(residuals_.cwiseAbs2()); }
  void add_derivatives(const Eigen::VectorXd& log_sigma, RestrictedFit& fit);

  JointRows rows_;
  Index own_ = -1;                               // the component of own errors
  std::vector<std::vector<Governed>> governed_;  // of own errors none: they are no elements of n
  Eigen::VectorXd is_own_row_;                   // 1 where a row has own errors, else 0
  double own_sigma_ = 0.0;
  double own_weight_ = 1.0;     // w = 1 / (1 + σ²)
  Eigen::VectorXd weights_;     // of rows: w of those, or 1
  Eigen::VectorXd told_scale_;  // of all unknowns: 1, and of n what is told
  Eigen::VectorXd scale_;
  Eigen::VectorXd diagonal_;  // of Bᵀ B
  Parts gradient_;
  NormalFactor factor_;
  Eigen::VectorXd v_;          // y in units of scale_
  Eigen::VectorXd residuals_;  // c + B y
  double chi2_ = 0.0;
  Eigen::VectorXd at_;  // what was evaluated last, and what came of it
  double deviance_ = 0.0;
};

}  // namespace fathom
