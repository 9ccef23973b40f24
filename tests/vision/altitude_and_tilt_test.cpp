// What errors of a picture's altitude, roll and pitch do to a registration.

#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "src/vision/motion_covariance.hpp"
#include "src/vision/rigid_motion.hpp"
#include "vision/fitted_points.hpp"
#include "vision/moved_points.hpp"

namespace fathom {
namespace {

using test::all_moved;
using test::CameraError;
using test::difference;
using test::Overlap;

// dz by the errors of either picture, assumed less true, by central differences of whole fits.
struct Responses {
  Eigen::Matrix3d from;
  Eigen::Matrix3d to;
};

Responses refitted_responses(const Overlap& seen) {
  constexpr double kStep = 1e-5;
  Responses responses;
  for (int i = 0; i < 3; ++i) {
    CameraError up, down;
    up[i] = kStep;
    down[i] = -kStep;
    const auto fit = [&](const CameraError& of_from, const CameraError& of_to) {
      return find_motion(all_moved(seen.p, seen.from, of_from), all_moved(seen.q, seen.to, of_to),
                         seen.weights)
          .value();
    };
    responses.from.col(i) = difference(fit(up, {}), fit(down, {})) / (2.0 * kStep);
    responses.to.col(i) = difference(fit({}, up), fit({}, down)) / (2.0 * kStep);
  }
  return responses;
}

// σ² dz dzᵀ over the errors of both pictures.
Eigen::Matrix3d refitted(const Overlap& seen, const CovarianceOptions& options) {
  const auto sigmas = [&](const Viewpoint& view) {
    const double tilt_rad = view.tilt_sigma_rad.value_or(options.tilt());
    const double altitude_m =
        view.altitude_sigma_m > options.altitude() ? view.altitude_sigma_m : options.altitude();
    return Eigen::Vector3d(altitude_m, tilt_rad, tilt_rad);
  };
  const Responses responses = refitted_responses(seen);
  const Eigen::Matrix3d by_from = responses.from * sigmas(seen.from).asDiagonal();
  const Eigen::Matrix3d by_to = responses.to * sigmas(seen.to).asDiagonal();
  return by_from * by_from.transpose() + by_to * by_to.transpose();
}

Eigen::Matrix3d total(const LinearFit& fit, const Viewpoint& from, const Viewpoint& to,
                      const CovarianceOptions& options) {
  const SharedErrors shared = fit.altitude_and_tilt(from, to, options);
  return total_of(shared.from, shared.to);
}

TEST(LinearFit, AltitudeAndTiltEqualsRefitsOfMovedPoints) {
  const Overlap seen;
  const LinearFit fit(seen.motion, seen.p, seen.q, seen.weights);
  for (const CovarianceOptions& options :
       {CovarianceOptions{0.02, 0.0}, CovarianceOptions{0.0, 0.03},
        CovarianceOptions{0.02, 0.03}}) {
    const Eigen::Matrix3d expected = refitted(seen, options);
    const Eigen::Matrix3d found = total(fit, seen.from, seen.to, options);
    ASSERT_GT(expected.norm(), 1e-5);
    EXPECT_LT((found - expected).norm(), 1e-6 * expected.norm()) << found << "\n\n" << expected;
  }
}

// Signs too: an error of one picture moves its registrations together or against each other.
TEST(LinearFit, ResponsesEqualRefitsOfMovedPoints) {
  Overlap seen;
  seen.from.pitch_rad = 0.3;
  seen.to.pitch_rad = -0.4;
  const LinearFit fit(seen.motion, seen.p, seen.q, seen.weights);
  const SharedErrors shared = fit.altitude_and_tilt(seen.from, seen.to, {0.02, 0.03});
  const Responses expected = refitted_responses(seen);
  EXPECT_LT((shared.from.G - expected.from).norm(), 1e-6 * expected.from.norm());
  EXPECT_LT((shared.to.G - expected.to).norm(), 1e-6 * expected.to.norm());
  EXPECT_EQ(shared.from.sigma, Eigen::Vector3d(0.02, 0.03, 0.03));
}

// Pitch and the σ of each as measured; one of the two alone; and an exact one.
TEST(LinearFit, MeasuredTiltEqualsRefitsOfMovedPoints) {
  Overlap seen;
  seen.from.pitch_rad = 0.3;
  seen.to.pitch_rad = -0.4;
  const CovarianceOptions options{0.02, 0.03};
  const LinearFit fit(seen.motion, seen.p, seen.q, seen.weights);
  std::vector<double> traces;
  for (const auto& [of_from, of_to] :
       {std::pair<std::optional<double>, std::optional<double>>{0.01, 0.002},
        {0.01, std::nullopt},
        {std::nullopt, 0.002},
        {0.0, 0.01},
        {0.0, 0.0}}) {
    seen.from.tilt_sigma_rad = of_from;
    seen.to.tilt_sigma_rad = of_to;
    const Eigen::Matrix3d expected = refitted(seen, options);
    const Eigen::Matrix3d found = total(fit, seen.from, seen.to, options);
    EXPECT_LT((found - expected).norm(), 1e-6 * expected.norm()) << found << "\n\n" << expected;
    traces.push_back(found.trace());
  }
  EXPECT_LT(traces[0], 0.5 * traces[1]);
  EXPECT_LT(traces[4], traces[3]);
}

// The larger of what sensor and options state, picture by picture.
TEST(LinearFit, AStatedAltitudeSigmaEqualsRefitsOfMovedPoints) {
  Overlap seen;
  const CovarianceOptions options{0.02, 0.0};
  const LinearFit fit(seen.motion, seen.p, seen.q, seen.weights);
  const Eigen::Matrix3d by_options = total(fit, seen.from, seen.to, options);
  std::vector<double> traces;
  for (const auto& [of_from, of_to] :
       {std::pair{0.01, 0.02}, {0.05, 0.01}, {0.01, 0.05}, {0.05, 0.07}}) {
    seen.from.altitude_sigma_m = of_from;
    seen.to.altitude_sigma_m = of_to;
    const Eigen::Matrix3d expected = refitted(seen, options);
    const Eigen::Matrix3d found = total(fit, seen.from, seen.to, options);
    EXPECT_LT((found - expected).norm(), 1e-6 * expected.norm()) << found << "\n\n" << expected;
    traces.push_back(found.trace());
  }
  EXPECT_EQ(traces[0], by_options.trace());
  EXPECT_GT(traces[1], traces[0]);
  EXPECT_GT(traces[3], traces[2]);
}

// Measured as the options have it is the same to the last bit.
TEST(LinearFit, AMeasuredSigmaStandsForThatOfTheOptions) {
  Overlap seen;
  const CovarianceOptions options{0.02, 0.03};
  const LinearFit fit(seen.motion, seen.p, seen.q, seen.weights);
  const Eigen::Matrix3d by_options = total(fit, seen.from, seen.to, options);
  seen.from.tilt_sigma_rad = seen.to.tilt_sigma_rad = 0.03;
  EXPECT_EQ(total(fit, seen.from, seen.to, {0.02, 0.2}), by_options);
}

TEST(LinearFit, AltitudeAndTiltKnowsOnePictureFromTheOther) {
  // An altitude of the far picture alone: lower ones move a point by more of a metre for a metre.
  const Overlap seen;
  const LinearFit fit(seen.motion, seen.p, seen.q, seen.weights);
  const CovarianceOptions options{0.02, 0.0};
  const Eigen::Matrix3d both = total(fit, seen.from, seen.to, options);
  const Eigen::Matrix3d swapped = total(fit, seen.to, seen.from, options);
  EXPECT_GT((both - swapped).norm(), 0.1 * both.norm());
}

}  // namespace
}  // namespace fathom
