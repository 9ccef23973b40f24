#include "fathom/estimation/robust_loss.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "fathom/core/chi_squared.hpp"
#include "fathom/core/input_error.hpp"

namespace fathom {

void LossOptions::describe(OptionTable& table, bool has_truncated) {
  std::vector<std::pair<std::string, LossKind>> kinds{{"none", LossKind::none},
                                                      {"huber", LossKind::huber},
                                                      {"cauchy", LossKind::cauchy},
                                                      {"geman_mcclure", LossKind::geman_mcclure},
                                                      {"dcs", LossKind::dcs}};
  if (has_truncated) kinds.emplace_back("truncated", LossKind::truncated);
  table.enumeration<LossKind>(
      "loss", kind, kinds,
      "robust loss on registrations and absolute measurements; dead reckoning has "
      "none");
  const std::string of_truncated = has_truncated ? " (truncated: 99.98 %, or less)" : "";
  table.real_or_off("loss_scale", scale, Range::positive(), "sigma",
                    "whitened residual at which the loss sets in; off: that which makes a right "
                    "registration at the 99 % quantile weigh one half" +
                        of_truncated);
}

void LossOptions::check() const {
  if (scale && kind == LossKind::none) {
    throw InputError("loss_scale: without a loss it has no effect; set loss too");
  }
}

namespace {

double share_of(LossKind kind) {
  return kind == LossKind::truncated ? kTruncatedQuantile : kHalfWeightQuantile;
}

}  // namespace

double default_scale(LossKind kind) {
  return scale_of_half_weight(kind, chi_squared_quantile(share_of(kind), 3.0));
}

double squared_scale_share(LossKind kind, int rank) {
  const auto of_share = [](double share) {
    std::array<double, 4> shares{};
    for (std::size_t r = 0; r < shares.size(); ++r) {
      shares[r] = r == 0 ? 1.0
                         : chi_squared_quantile(share, static_cast<double>(r)) /
                               chi_squared_quantile(share, 3.0);
    }
    return shares;
  };
  static const std::array<double, 4> plain = of_share(kHalfWeightQuantile);
  static const std::array<double, 4> truncated = of_share(kTruncatedQuantile);
  return (kind == LossKind::truncated ? truncated : plain)[static_cast<std::size_t>(rank)];
}

double scale_of_half_weight(LossKind kind, double s) {
  switch (kind) {
    case LossKind::huber:
      return 0.5 * std::sqrt(s);
    case LossKind::geman_mcclure:
      return std::sqrt(s / (std::sqrt(2.0) - 1.0));
    case LossKind::dcs:
      return std::sqrt(s / (2.0 * std::sqrt(2.0) - 1.0));
    case LossKind::cauchy:
    case LossKind::truncated:
    case LossKind::none:
      break;
  }
  return std::sqrt(s);
}

RobustLoss::RobustLoss(const LossOptions& options)
    : RobustLoss(options.kind, options.scale.value_or(default_scale(options.kind))) {}

double RobustLoss::scale() const {
  return std::sqrt(squared_scale_);
}

LossValue RobustLoss::at(double s) const {
  const double a = squared_scale_;
  switch (kind_) {
    case LossKind::huber: {
      if (s <= a) break;
      const double weight = std::sqrt(a / s);
      return {2.0 * std::sqrt(a * s) - a, weight, -0.5 * weight / s};
    }
    case LossKind::cauchy: {
      const double weight = a / (a + s);
      return {a * std::log1p(s / a), weight, -weight / (a + s)};
    }
    case LossKind::geman_mcclure: {
      const double root = a / (a + s);
      return {root * s, root * root, -2.0 * root * root / (a + s)};
    }
    case LossKind::dcs: {
      if (s <= a) break;
      const double factor = 2.0 * a / (a + s);
      return {a * (3.0 * s - a) / (a + s), factor * factor, -2.0 * factor * factor / (a + s)};
    }
    case LossKind::truncated:
      if (s > a) return {a, 0.0, 0.0};
      break;
    case LossKind::none:
      break;
  }
  return {s, 1.0, 0.0};
}

RobustLoss RobustLoss::widened(double factor) const {
  RobustLoss wide = *this;
  wide.squared_scale_ *= factor;
  return wide;
}

}  // namespace fathom
