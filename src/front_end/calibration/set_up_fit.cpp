#include "set_up_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "fathom/core/median.hpp"
#include "residuals.hpp"
#include "set_up_normal.hpp"

namespace fathom {
namespace {

// A first estimate, and how likely the motions are with it.
struct Start {
  SetUpParameters value;
  double log_density = 0.0;
};

// The median times a factor, with its standard deviation of normal values.
Estimated middle_of(const std::vector<double>& values, double factor) {
  constexpr double kOfMedian = 1.2533;  // √(π / 2)
  const double middle = upper_median(values);
  std::vector<double> off;
  off.reserve(values.size());
  for (const double value : values) off.push_back(std::abs(value - middle));
  const double sigma = upper_median(off) / kHalfNormalMedian;
  return {factor * middle,
          factor * kOfMedian * sigma / std::sqrt(static_cast<double>(values.size()))};
}

class Fit {
 public:
  Fit(std::span<const SeenMotion> motions, const OdometryTrack& track, const SetUpPrior& prior)
      : motions_(motions), track_(track), prior_(prior) {
    std::vector<double> times_s;
    for (const SeenMotion& motion : motions_) times_s.push_back(seconds_of(motion));
    median_s_ = upper_median(times_s);
  }

  std::optional<SetUpFit> fitted() const {
    const auto best = start();
    auto fit = best ? refined(best->value) : std::nullopt;
    if (fit) fit->most_log_density = std::max(best->log_density, fit->log_density);
    if (fit && !tells_clock(fit->value)) {
      fit->covariance(4, 4) = prior_.sigma_time_s * prior_.sigma_time_s;
    }
    return fit;
  }

 private:
  static constexpr double kMostOffset_s = 5.0;
  static constexpr double kOffsetStep_s = 0.25;
  static constexpr std::size_t kFewest = 8;

  // The likeliest of time offsets so far apart, with the rest by linear least squares. The clocks
  // agree, unless another offset is far more likely than none.
  std::optional<Start> start() const {
    constexpr double kGain = 10.0;
    auto best = start_at(prior_.mean.time_offset_s);
    double least = best ? best->log_density + kGain : -std::numeric_limits<double>::infinity();
    const int steps = static_cast<int>(std::lround(kMostOffset_s / kOffsetStep_s));
    for (int step = -steps; step <= steps; ++step) {
      const auto one = start_at(kOffsetStep_s * step);
      if (!one || !(one->log_density > least)) continue;
      best = one;
      least = one->log_density;
    }
    return best;
  }

  std::optional<Pose> reckoned(const SeenMotion& motion, double offset_s) const {
    const std::int64_t shift_ns = nanoseconds(offset_s);
    return track_.motion(motion.from_ns - shift_ns, motion.to_ns - shift_ns);
  }

  // All that are covered; nothing where these are fewer than most.
  std::vector<Beside> beside(double offset_s) const {
    std::vector<Beside> covered;
    for (std::size_t i = 0; i < motions_.size(); ++i) {
      const auto at = reckoned(motions_[i], offset_s);
      if (!at) continue;
      covered.push_back({i, motions_[i].camera, *at, change_of(motions_, i),
                         std::sqrt(seconds_of(motions_[i]) / median_s_), motions_[i].variance_m2});
    }
    constexpr double kMost = 0.7;
    const bool are_enough =
        covered.size() >= kFewest &&
        static_cast<double>(covered.size()) >= kMost * static_cast<double>(motions_.size());
    return are_enough ? covered : std::vector<Beside>{};
  }

  static std::vector<double> weights_of(const std::vector<Beside>& beside, const SetUpParameters& p,
                                        const ResidualSpread& spread) {
    std::vector<double> weights;
    weights.reserve(beside.size());
    for (const Beside& one : beside) weights.push_back(spread.weight(residual_of(one, p)));
    return weights;
  }

  // As if all motions were covered: fewer of them must not win.
  double density_of_all(const std::vector<Beside>& covered, const SetUpParameters& p,
                        const ResidualSpread& spread) const {
    return spread.log_density(covered, p) * static_cast<double>(motions_.size()) /
           static_cast<double>(covered.size());
  }

  // With the time offset held the rest is linear: t = (I − R(θ)) l + [a −b; b a] t_camera.
  SetUpParameters linear(const std::vector<Beside>& beside, const std::vector<double>& weights,
                         double offset_s, double sigma_m) const {
    Eigen::Matrix4d H = Eigen::Matrix4d::Zero();
    Eigen::Vector4d g = Eigen::Vector4d::Zero();
    for (std::size_t i = 0; i < beside.size(); ++i) {
      const Beside& one = beside[i];
      Eigen::Matrix<double, 2, 4> J;
      J << one.seen.x, -one.seen.y, 0.0, 0.0, one.seen.y, one.seen.x, 0.0, 0.0;
      J.rightCols<2>() = arm_of(one);
      const double weight = weights[i] / (one.noise * one.noise * sigma_m * sigma_m);
      H += weight * J.transpose() * J;
      g += weight * J.transpose() * one.reckoned.position();
    }
    const double of_lever = 1.0 / (prior_.sigma_lever_m * prior_.sigma_lever_m);
    H(2, 2) += of_lever;
    H(3, 3) += of_lever;
    g(2) += of_lever * prior_.mean.lever_x_m;
    g(3) += of_lever * prior_.mean.lever_y_m;
    H.diagonal().array() += 1e-12;  // pictures that never move tell no scale
    const Eigen::Vector4d x = H.ldlt().solve(g);
    return {std::log(std::max(1e-9, std::hypot(x(0), x(1)))), std::atan2(x(1), x(0)), x(2), x(3),
            offset_s};
  }

  std::optional<Start> start_at(double offset_s) const {
    const std::vector<Beside> covered = beside(offset_s);
    if (covered.empty()) return std::nullopt;
    SetUpParameters p = linear(covered, std::vector<double>(covered.size(), 1.0), offset_s, 1.0);
    constexpr int kRounds = 5;
    ResidualSpread spread = spread_of(covered, p);
    for (int round = 0; round < kRounds; ++round) {
      p = linear(covered, weights_of(covered, p, spread), offset_s, spread.sigma_m);
      spread = spread_of(covered, p);
    }
    return Start{p, density_of_all(covered, p, spread)};
  }

  // Whether a clock a second off would be less likely by much. In an even motion noise alone passes
  // for changes.
  bool tells_clock(const SetUpParameters& p) const {
    constexpr double kOff_s = 1.0;
    constexpr double kLoss = 10.0;
    const auto here = start_at(p.time_offset_s);
    const auto before = start_at(p.time_offset_s - kOff_s);
    const auto after = start_at(p.time_offset_s + kOff_s);
    const auto is_lower = [&](const std::optional<Start>& there) {
      return !there || there->log_density < here->log_density - kLoss;
    };
    return here && is_lower(before) && is_lower(after);
  }

  std::optional<SetUpFit> refined(SetUpParameters p) const {
    constexpr int kRounds = 12;
    const Vector5 information = prior_.information();
    for (int round = 0; round < kRounds; ++round) {
      const std::vector<Beside> covered = beside(p.time_offset_s);
      if (covered.empty()) return std::nullopt;
      const ResidualSpread spread = spread_of(covered, p);
      SetUpNormal normal = normal_of(covered, p, spread);
      normal.H += information.asDiagonal();
      normal.g += information.cwiseProduct(p.vector() - prior_.mean.vector());
      Vector5 step = -normal.H.ldlt().solve(normal.g);
      constexpr double kMostStep_s = 0.25;
      step *= std::min(1.0, kMostStep_s / std::max(1e-12, std::abs(step(4))));
      p = SetUpParameters::from_vector(p.vector() + step);
      p.yaw_rad = wrap_angle(p.yaw_rad);
    }
    return described(p);
  }

  std::optional<SetUpFit> described(const SetUpParameters& p) const {
    const std::vector<Beside> covered = beside(p.time_offset_s);
    if (covered.empty()) return std::nullopt;
    const ResidualSpread spread = spread_of(covered, p);
    const SetUpNormal normal = normal_of(covered, p, spread);
    SetUpFit fit;
    fit.value = p;
    fit.motions = covered.size();
    fit.sigma_m = spread.sigma_m;
    fit.sigma_rad = spread.sigma_rad;
    fit.log_density = density_of_all(covered, p, spread);
    // Of M-estimates whatever the residuals' distribution (Huber's sandwich), with the prior.
    const Vector5 information = prior_.information();
    const Matrix5 H = normal.curvature + Matrix5(information.asDiagonal());
    const auto count = static_cast<double>(covered.size());
    const Matrix5 scores =
        count / (count - 5.0) * normal.scores + Matrix5(information.asDiagonal());
    const Matrix5 inverse = H.ldlt().solve(Matrix5::Identity());
    fit.covariance = inverse * scores * inverse.transpose();
    // Registrations know their covariance to a half.
    fit.covariance(0, 0) += 0.25 * normal.noise_bias * normal.noise_bias;
    std::vector<double> lengths_m;
    std::vector<double> shares;
    for (std::size_t i = 0; i < covered.size(); ++i) {
      const Beside& one = covered[i];
      lengths_m.push_back(one.reckoned.position().norm());
      const Eigen::Vector2d seen = turned(one, p);
      const Eigen::Vector2d arm = arm_of(one) * Eigen::Vector2d(p.lever_x_m, p.lever_y_m);
      const Eigen::Vector2d reckoned = one.reckoned.position() - arm;
      const double squared = seen.squaredNorm();
      fit.each.push_back({one.index, squared > 0.0 ? reckoned.dot(seen) / squared : 1.0});
      const double length = reckoned.squaredNorm();
      if (length > 0.0) shares.push_back(seen.dot(reckoned) / length);
    }
    // In the middle: weights by residuals would keep the errors that agree with the scale.
    if (!shares.empty()) fit.least_scale = middle_of(shares, std::exp(-p.log_scale));
    fit.median_m = upper_median(lengths_m);
    return fit;
  }

  std::span<const SeenMotion> motions_;
  const OdometryTrack& track_;
  const SetUpPrior& prior_;
  double median_s_ = 1.0;
};

}  // namespace

std::optional<SetUpFit> fit_set_up(std::span<const SeenMotion> motions, const OdometryTrack& track,
                                   const SetUpPrior& prior) {
  return motions.empty() || track.is_empty() ? std::nullopt : Fit(motions, track, prior).fitted();
}

}  // namespace fathom
