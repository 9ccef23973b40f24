// What some registrations give, number by number. A change of them without a new
// kRegistrationVersion would mix old and new registrations in one cache.
//
// Differences are in standard deviations of the registration. OpenCV without AVX2 and FMA
// (OPENCV_CPU_DISABLE=AVX2,FMA3) changes registrations of pictures by up to 1.5e-5 of them; other
// kernels of OpenBLAS and of the C library change nothing.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/front_end/pair_registrar.hpp"
#include "front_end/floor_survey.hpp"
#include "support/data.hpp"
#include "vision/labelled.hpp"

namespace fathom {
namespace {

constexpr int kPinnedVersion = 10;
constexpr double kOfPictures = 2e-4;
constexpr double kOfPoints = 1e-9;

// Covariance: xx, xy, xθ, yy, yθ, θθ.
struct Pinned {
  int inliers = 0;
  Pose motion;
  std::array<double, 6> covariance{};
};

Pinned pinned(const PairRegistration& found) {
  const Eigen::Matrix3d& C = found.covariance;
  return {found.inliers, found.motion, {C(0, 0), C(0, 1), C(0, 2), C(1, 1), C(1, 2), C(2, 2)}};
}

// As it stands in this file.
std::string text_of(const Pinned& pin) {
  const Pose& z = pin.motion;
  std::string text = "{" + std::to_string(pin.inliers) + ", {" + exact(z.x) + ", " + exact(z.y) +
                     ", " + exact(z.theta) + "}, {";
  for (const double number : pin.covariance) text += exact(number) + ", ";
  return text.substr(0, text.size() - 2) + "}}";
}

// The largest difference, of the motion in standard deviations, of the covariance in products of
// them.
double difference(const Pinned& a, const Pinned& b) {
  const Eigen::Vector3d sigma =
      Eigen::Vector3d(b.covariance[0], b.covariance[3], b.covariance[5]).cwiseSqrt();
  Eigen::Vector3d motion = a.motion.vector() - b.motion.vector();
  motion.z() = wrap_angle(motion.z());
  double most = motion.cwiseQuotient(sigma).cwiseAbs().maxCoeff();
  std::size_t n = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j, ++n) {
      most = std::max(most, std::abs(a.covariance[n] - b.covariance[n]) / (sigma[i] * sigma[j]));
    }
  }
  return most;
}

void expect_pinned(const PairRegistration& found, const Pinned& expected,
                   double tolerance = kOfPictures) {
  ASSERT_TRUE(found.found);
  const Pinned now = pinned(found);
  const bool is_same = now.inliers == expected.inliers && difference(now, expected) <= tolerance;
  EXPECT_TRUE(is_same && kRegistrationVersion == kPinnedVersion)
      << "registrations are not what they were: raise kRegistrationVersion and record these "
         "numbers again, by\n"
      << text_of(now) << "\nthe difference is " << difference(now, expected) << " in place of "
      << tolerance << " at most";
}

struct Case {
  Case() {
    registration.ransac.max_error_m = 0.03;
    registration.covariance.floor_sigma_m = 1e-5;
    registration.covariance.tilt_sigma_rad = 0.0;
  }

  FeatureOptions features;
  RegistrationOptions registration;
};

// Two frames with some overlap, at unlike altitudes.
PairRegistration rendered(const Case& options) {
  const test::FloorSurvey survey({{-0.8, -0.5, 0.1}, {-0.4, -0.35, 0.5}});
  PairRegistrar registrar(survey, options.features, options.registration, 5);
  return registrar.of({0, test::kAltitudeM}, {1, 1.02 * test::kAltitudeM});
}

TEST(PinnedRegistrations, OfRenderedPictures) {
  expect_pinned(rendered({}),
                {352,
                 {0.41736789084633685, 0.10963056211602989, 0.40003984212518712},
                 {7.4403329468173627e-06, 4.9561273453881593e-08, 1.2382055772467768e-06,
                  7.3980308457700462e-06, 8.1782469822973222e-07, 2.043208311884595e-05}});
}

TEST(PinnedRegistrations, OfBinaryDescriptors) {
  Case orb;
  orb.features.type = "orb";
  expect_pinned(rendered(orb),
                {251,
                 {0.41869124690778459, 0.10814071911970433, 0.39876954283519139},
                 {3.0943221933166691e-07, 1.7883063129089147e-08, 1.9944583774182125e-07,
                  2.9815192833544745e-07, 1.4622696957011736e-07, 1.6309369676848146e-06}});
}

TEST(PinnedRegistrations, ByThePapersCriterion) {
  Case paper;
  paper.registration.decision.method = DecisionOptions::Method::inliers;
  expect_pinned(rendered(paper),
                {343,
                 {0.41722741352533455, 0.10977239089141501, 0.40006816764803543},
                 {7.0813445060995083e-06, 3.5355245024313436e-08, 1.0728932431184316e-06,
                  7.0455905935472959e-06, 6.5975286008286694e-07, 2.0021015856309033e-05}});
  paper.registration.ransac.score = RansacScore::paper;
  expect_pinned(rendered(paper),
                {93,
                 {0.41981471728038927, 0.098153186690141947, 0.39998801111166726},
                 {1.1553612258783505e-06, 2.42508630049935e-07, 1.458827061629716e-06,
                  2.8523463188881648e-07, 3.7912243183481741e-07, 2.2807366236022824e-06}});
}

// Points with errors of 4 mm, a quarter of them wrong; exact but for the arithmetic of a fit.
PairRegistration of_points(const RegistrationOptions& options) {
  RandomStream random(9);
  std::vector<Eigen::Vector2d> p, q;
  for (int i = 0; i < 120; ++i) {
    const double x = random.uniform(-1.0, 1.0);
    q.emplace_back(x, random.uniform(-1.0, 1.0));
    const double sigma_m = i % 4 == 0 ? 0.5 : 0.004;
    const double dx = sigma_m * random.normal();
    const double dy = sigma_m * random.normal();
    p.push_back(transform({0.3, -0.2, 0.7}, q.back()) + Eigen::Vector2d(dx, dy));
  }
  const Registration r = register_pair(test::labelled(p), test::labelled(q), options, 1);
  return {r.found, r.motion, r.covariance, static_cast<int>(r.inliers.size())};
}

TEST(PinnedRegistrations, OfPoints) {
  expect_pinned(of_points(Case().registration),
                {89,
                 {0.30048410446964674, -0.19896237700434702, 0.69952282879613137},
                 {1.7922185314073787e-07, 1.7566468013208744e-10, -4.9245787753356901e-09,
                  1.7938178032292555e-07, -7.6524901987024667e-09, 2.1462969818780804e-07}},
                kOfPoints);
}

// The pins are sharp: a tuned number that was another by a tenth would be seen. (Tuned numbers are
// in a registration's key besides.)
TEST(PinnedRegistrations, TellASharedErrorOf0055FromOneOf005) {
  Case before;
  before.registration.tuning.covariance.shared_error = 0.05;
  EXPECT_GT(difference(pinned(rendered(before)), pinned(rendered({}))), 10.0 * kOfPictures);
  EXPECT_GT(
      difference(pinned(of_points(before.registration)), pinned(of_points(Case().registration))),
      1e5 * kOfPoints);
}

TEST(PinnedRegistrations, OfRealPictures) {
  FATHOM_REQUIRE_DATA("copr/mav0");
  const ImageFolder survey(test::data_path("copr"));
  Case kite;
  kite.registration.ransac.max_error_m = 0.2;
  kite.registration.covariance.tilt_sigma_rad = 0.005;
  kite.registration.covariance.floor_sigma_rad = 0.012;
  PairRegistrar registrar(survey, kite.features, kite.registration, 5);
  expect_pinned(registrar.of({0, survey.info(0).altitude_m}, {2, survey.info(2).altitude_m}),
                {245,
                 {-6.2412693255671954, 1.457919802539186, -0.062913582658453968},
                 {0.016804435722113611, -0.00015576065299708871, -5.2211423433606699e-06,
                  0.016968428666350271, -1.0021988427608965e-05, 0.00014802280979686546}});
}

}  // namespace
}  // namespace fathom
