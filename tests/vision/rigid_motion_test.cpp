#include "src/vision/rigid_motion.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "fathom/core/input_error.hpp"
#include "fathom/core/random.hpp"
#include "vision/points.hpp"

namespace fathom {
namespace {

using test::Points;

Points random_points(RandomStream& random, int count, double size_m) {
  Points points;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-size_m, size_m);
    points.emplace_back(x, random.uniform(-size_m, size_m));
  }
  return points;
}

Points seen_from(const Pose& z, const Points& q, RandomStream& random, double sigma_m) {
  Points p;
  for (const Eigen::Vector2d& point : q) {
    const double noise_x = sigma_m * random.normal();
    const double noise_y = sigma_m * random.normal();
    p.push_back(transform(z, point) + Eigen::Vector2d(noise_x, noise_y));
  }
  return p;
}

// Kabsch's algorithm with the determinant forced to +1: another way to the same optimum.
Pose by_svd(const Points& p, const Points& q) {
  Eigen::Vector2d p_mean = Eigen::Vector2d::Zero();
  Eigen::Vector2d q_mean = Eigen::Vector2d::Zero();
  for (std::size_t j = 0; j < p.size(); ++j) {
    p_mean += p[j] / static_cast<double>(p.size());
    q_mean += q[j] / static_cast<double>(p.size());
  }
  Eigen::Matrix2d H = Eigen::Matrix2d::Zero();
  for (std::size_t j = 0; j < p.size(); ++j) H += (q[j] - q_mean) * (p[j] - p_mean).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix2d D = Eigen::Matrix2d::Identity();
  D(1, 1) = (svd.matrixV() * svd.matrixU().transpose()).determinant();
  const Eigen::Matrix2d R = svd.matrixV() * D * svd.matrixU().transpose();
  const Eigen::Vector2d t = p_mean - R * q_mean;
  return {t.x(), t.y(), std::atan2(R(1, 0), R(0, 0))};
}

void expect_near(const Pose& a, const Pose& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(wrap_angle(a.theta - b.theta), 0.0, tolerance);
}

TEST(FindMotion, RecoversAnExactMotion) {
  RandomStream random(1);
  for (const double theta :
       {0.0, 1e-9, 0.7, -2.0, std::numbers::pi, std::nextafter(-std::numbers::pi, 0.0)}) {
    for (const int count : {2, 3, 50}) {
      const Points q = random_points(random, count, 3.0);
      const Pose z{4.0, -7.0, theta};
      const auto found = find_motion(seen_from(z, q, random, 0.0), q);
      ASSERT_TRUE(found.has_value());
      expect_near(*found, z, 1e-12);
    }
  }
}

TEST(FindMotion, EqualsTheSvdSolutionOnNoisyPoints) {
  RandomStream random(2);
  for (int i = 0; i < 100; ++i) {
    const Points q = random_points(random, 2 + i % 20, 2.0);
    const Pose z{random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0), random.uniform(-3.1, 3.1)};
    const Points p = seen_from(z, q, random, 0.2);
    expect_near(find_motion(p, q).value(), by_svd(p, q), 1e-10);
  }
}

TEST(FindMotion, IsAMinimum) {
  RandomStream random(3);
  const Points q = random_points(random, 12, 2.0);
  const Points p = seen_from({1.0, 2.0, 0.5}, q, random, 0.3);
  const Pose z = find_motion(p, q).value();
  const double least = squared_error(z, p, q);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-1e-3, 1e-3}) {
      Eigen::Vector3d moved = z.vector();
      moved[axis] += step;
      EXPECT_GT(squared_error(Pose::from_vector(moved), p, q), least);
    }
  }
}

TEST(FindMotion, NeverReflects) {
  // A mirror image is fitted best by a reflection, which a rotation must not become: the best
  // rotation leaves an error, and the SVD with its determinant forced agrees.
  RandomStream random(4);
  for (int i = 0; i < 50; ++i) {
    const Points q = random_points(random, 6, 2.0);
    Points p;
    for (const Eigen::Vector2d& point : q) p.emplace_back(point.x(), -point.y());
    const Pose z = find_motion(p, q).value();
    EXPECT_GT(squared_error(z, p, q), 1e-3);
    expect_near(z, by_svd(p, q), 1e-8);
  }
}

TEST(FindMotion, IsNothingWhereNoHeadingIsBest) {
  const Points square{{1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}};
  const Points mirrored{{1.0, 0.0}, {0.0, -1.0}, {-1.0, 0.0}, {0.0, 1.0}};
  const Points one_place(4, Eigen::Vector2d(123.4, -0.1));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(find_motion({}, {}).has_value());
  EXPECT_FALSE(find_motion(Points{{1.0, 2.0}}, Points{{0.0, 0.0}}).has_value());
  EXPECT_FALSE(find_motion(one_place, square).has_value());
  EXPECT_FALSE(find_motion(square, one_place).has_value());
  EXPECT_FALSE(find_motion(one_place, one_place).has_value());
  EXPECT_FALSE(find_motion(mirrored, square).has_value());
  EXPECT_FALSE(find_motion(Points{{0.0, 0.0}, {nan, 1.0}}, Points{{0.0, 0.0}, {1.0, 1.0}}));
  EXPECT_FALSE(find_motion(Points{{0.0, 0.0}, {1e300, 1.0}}, Points{{0.0, 0.0}, {1e300, 1.0}}));
  EXPECT_THROW(find_motion(square, Points{{0.0, 0.0}}), InputError);
}

TEST(FindMotion, KeepsItsDigitsFarFromTheOrigin) {
  const Points q{{1e5, 1e5}, {1e5 + 1.0, 1e5}, {1e5, 1e5 + 2.0}};
  Points p;
  for (const Eigen::Vector2d& point : q) p.push_back(rotation(0.3) * point);
  const Pose z = find_motion(p, q).value();
  EXPECT_NEAR(z.theta, 0.3, 1e-9);
}

// Newton's method on the weighted sum of squares, with derivatives by central differences.
Pose by_newton(const Points& p, const Points& q, const std::vector<double>& weights, Pose start) {
  const auto cost = [&](const Eigen::Vector3d& z) {
    double sum = 0.0;
    for (std::size_t j = 0; j < p.size(); ++j) {
      sum += weights[j] * (p[j] - transform(Pose::from_vector(z), q[j])).squaredNorm();
    }
    return sum;
  };
  constexpr double kStep = 1e-4;
  Eigen::Vector3d z = start.vector();
  for (int round = 0; round < 12; ++round) {
    Eigen::Vector3d gradient;
    Eigen::Matrix3d hessian;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d di = kStep * Eigen::Vector3d::Unit(i);
      gradient[i] = (cost(z + di) - cost(z - di)) / (2.0 * kStep);
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d dk = kStep * Eigen::Vector3d::Unit(k);
        hessian(i, k) =
            (cost(z + di + dk) - cost(z + di - dk) - cost(z - di + dk) + cost(z - di - dk)) /
            (4.0 * kStep * kStep);
      }
    }
    z -= hessian.ldlt().solve(gradient);
  }
  return Pose::from_vector(z);
}

TEST(FindMotionWithWeights, AWeightOfThreeIsThreeCopies) {
  RandomStream random(7);
  for (int i = 0; i < 30; ++i) {
    const Points q = random_points(random, 3 + i, 2.0);
    const Points p = seen_from({1.0, -2.0, random.uniform(-3.0, 3.0)}, q, random, 0.2);
    std::vector<double> weights;
    Points repeated_p, repeated_q;
    for (std::size_t j = 0; j < p.size(); ++j) {
      const std::size_t copies = 1 + j % 3;
      weights.push_back(static_cast<double>(copies));
      repeated_p.insert(repeated_p.end(), copies, p[j]);
      repeated_q.insert(repeated_q.end(), copies, q[j]);
    }
    expect_near(find_motion(p, q, weights).value(), by_svd(repeated_p, repeated_q), 1e-10);
  }
}

TEST(FindMotionWithWeights, IsTheMinimumOfTheWeightedSum) {
  RandomStream random(8);
  for (int i = 0; i < 20; ++i) {
    const Pose z{0.4, -0.3, random.uniform(-2.5, 2.5)};
    const Points q = random_points(random, 12, 2.0);
    const Points p = seen_from(z, q, random, 0.2);
    std::vector<double> weights;
    for (std::size_t j = 0; j < p.size(); ++j) weights.push_back(std::exp(2.0 * random.normal()));
    expect_near(find_motion(p, q, weights).value(), by_newton(p, q, weights, z), 1e-6);
  }
}

TEST(FindMotionWithWeights, DoesNotDependOnTheirScale) {
  RandomStream random(9);
  const Points q = random_points(random, 9, 2.0);
  const Points p = seen_from({1.0, -2.0, 0.6}, q, random, 0.2);
  const std::vector<double> tiny(9, 1e-12);
  expect_near(find_motion(p, q, tiny).value(), find_motion(p, q).value(), 1e-12);
  EXPECT_THROW(find_motion(p, q, std::vector<double>(8, 1.0)), InputError);
}

}  // namespace
}  // namespace fathom
