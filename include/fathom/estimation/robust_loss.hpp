#pragma once

#include <optional>
#include <string>

#include "fathom/core/options.hpp"

namespace fathom {

/// Losses ρ(s) of a registration's squared whitened residual s = eᵀ Ω e, with the scale c:
///
/// | name          | ρ(s)                                       | weight ρ'(s)              |
/// |---------------|--------------------------------------------|---------------------------|
/// | none          | s                                          | 1                         |
/// | huber         | s up to c², then 2 c √s − c²               | min(1, c / √s)            |
/// | cauchy        | c² ln(1 + s / c²)                          | 1 / (1 + s / c²)          |
/// | geman_mcclure | c² s / (c² + s)                            | (c² / (c² + s))²          |
/// | dcs           | s up to c², then c² (3 s − c²) / (c² + s)  | min(1, 2 c² / (c² + s))²  |
/// | truncated     | min(s, c²)                                 | 1 up to c², then 0        |
///
/// `dcs` is dynamic covariance scaling (Agarwal, Tipaldi, Spinello, Stachniss and Burgard 2013):
/// Ω times the square of their factor, with Φ = c²; its ρ is the integral of that weight.
/// `truncated` has no useful gradient: an estimator that takes it decides otherwise who is out.
enum class LossKind { none, huber, cauchy, geman_mcclure, dcs, truncated };

/// ρ and its first two derivatives.
struct LossValue {
  double rho = 0.0;
  double weight = 1.0;
  double curvature = 0.0;  ///< ρ''
};

struct LossOptions {
  LossKind kind = LossKind::none;
  /// c, in units of √s; absent: where a registration at the 99 % quantile of χ²₃ weighs one half;
  /// of `truncated`, where 99.98 % end.
  std::optional<double> scale;

  /// `loss` and `loss_scale`; `truncated` is offered where an estimator has a way to it.
  void describe(OptionTable& table, bool has_truncated = false);
  /// A scale without a loss would go unread. Throws InputError.
  void check() const;
};

/// What the squared scale of a measurement with so many rows is to that of a registration: the
/// ratio of the quantiles of χ² with so many and with 3 degrees of freedom, at the share that sets
/// the default scale. A right measurement is doubted as seldom, whatever it measures.
double squared_scale_share(LossKind kind, int rank);

class RobustLoss {
 public:
  RobustLoss() = default;
  explicit RobustLoss(const LossOptions& options);
  RobustLoss(LossKind kind, double scale) : kind_(kind), squared_scale_(scale * scale) {}

  LossKind kind() const { return kind_; }
  bool is_on() const { return kind_ != LossKind::none; }
  double scale() const;
  double squared_scale() const { return squared_scale_; }

  /// Of s ≥ 0.
  LossValue at(double s) const;
  double weight(double s) const { return at(s).weight; }

  /// The same loss with another scale, whose square is `factor` times as large.
  RobustLoss widened(double factor) const;
  /// That of an absolute measurement with so many independent rows.
  RobustLoss of_rank(int rank) const {
    return rank == 3 ? *this : widened(squared_scale_share(kind_, rank));
  }

 private:
  LossKind kind_ = LossKind::none;
  double squared_scale_ = 1.0;
};

/// A right registration at this quantile of χ²₃ weighs one half where no scale is given; one of
/// `truncated`, which is judged without its own pull and is in or out, at the other.
inline constexpr double kHalfWeightQuantile = 0.99;
inline constexpr double kTruncatedQuantile = 0.9998;

/// The scale where none is given.
double default_scale(LossKind kind);

/// The scale at which a residual of squared norm s weighs one half.
double scale_of_half_weight(LossKind kind, double s);

}  // namespace fathom
