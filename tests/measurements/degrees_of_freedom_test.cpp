// Against the rows and the numerical rank of the whole Jacobian.

#include <string>
#include <vector>

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/measurement_log.hpp"
#include "measurements/parsed_graph.hpp"

namespace fathom {
namespace {

class Jacobian {
 public:
  Jacobian(const MeasurementLog& log, const std::vector<Pose>& poses)
      : unknowns_(3 * static_cast<Eigen::Index>(log.size())) {
    for (const RelativePose& z : log.edges()) {
      Eigen::Matrix3d J_from;
      Eigen::Matrix3d J_to;
      residual(z.motion, poses[z.from], poses[z.to], &J_from, &J_to);
      const Eigen::Matrix3d root = z.information.llt().matrixU();
      add(root, z.from, J_from, z.to, J_to);
    }
    if (log.start().is_fixed()) {
      held_ = 3;
    } else if (!log.start().is_free) {
      add(log.start().measurement(), poses);
    }
    for (std::size_t k = 0; k < log.size(); ++k) {
      for (const AbsolutePose& z : log.arrival(k).absolute) add(z, poses);
    }
  }

  double degrees_of_freedom() const {
    const auto rows = static_cast<Eigen::Index>(rows_.size());
    if (rows == 0) return 0.0;
    Eigen::MatrixXd J(rows, unknowns_ - held_);
    for (Eigen::Index i = 0; i < rows; ++i) {
      J.row(i) = rows_[static_cast<std::size_t>(i)].tail(J.cols()).transpose();
    }
    for (Eigen::Index j = 0; j < J.cols(); ++j) {
      if (J.col(j).norm() > 0.0) J.col(j).normalize();
    }
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(J);
    svd.setThreshold(1e-7);
    return static_cast<double>(rows - svd.rank());
  }

 private:
  void add(const AbsolutePose& z, const std::vector<Pose>& poses) {
    Eigen::Matrix3d J;
    residual(z, poses[z.keyframe], &J);
    const InformationRows measured = rows_of(z.information);
    for (int i = 0; i < measured.rank; ++i) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(unknowns_);
      row.segment<3>(static_cast<Eigen::Index>(3 * z.keyframe)) =
          (measured.rows.row(i) * J).transpose();
      rows_.push_back(row);
    }
  }

  void add(const Eigen::Matrix3d& root, std::size_t from, const Eigen::Matrix3d& J_from,
           std::size_t to, const Eigen::Matrix3d& J_to) {
    for (int i = 0; i < 3; ++i) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(unknowns_);
      row.segment<3>(static_cast<Eigen::Index>(3 * from)) = (root.row(i) * J_from).transpose();
      row.segment<3>(static_cast<Eigen::Index>(3 * to)) = (root.row(i) * J_to).transpose();
      rows_.push_back(row);
    }
  }

  Eigen::Index unknowns_;
  Eigen::Index held_ = 0;
  std::vector<Eigen::VectorXd> rows_;
};

Pose drawn_pose(RandomStream& random, double reach_m) {
  return {reach_m * random.normal(), reach_m * random.normal(), random.normal()};
}

// A heading, a fix, one of an antenna off the middle, a pose, one coordinate alone.
AbsolutePose drawn_absolute(RandomStream& random, std::size_t k, const Pose& at) {
  const Eigen::Matrix2d fix = 0.04 * Eigen::Matrix2d::Identity();
  const double kind = 5.0 * random.uniform();
  if (kind < 1.0) return AbsolutePose::heading(k, at.theta, 0.02);
  if (kind < 2.0) return AbsolutePose::position(k, at.position(), fix);
  if (kind < 3.0) {
    const Eigen::Vector2d lever(0.5, 0.2);
    return fix_of_point(k, transform(at, lever), fix, {}, lever, at.theta);
  }
  if (kind < 4.0) return AbsolutePose::from_covariance(k, at, Eigen::Matrix3d::Identity());
  AbsolutePose one{k, {at.x, at.y, 0.0}, Eigen::Matrix3d::Zero()};
  one.information(0, 0) = 25.0;
  return one;
}

StartPose drawn_start(RandomStream& random, const Pose& at) {
  StartPose start(at);
  const double kind = 3.0 * random.uniform();
  if (kind < 1.0) start.covariance = 0.01 * Eigen::Matrix3d::Identity();
  start.is_free = kind > 2.0;
  return start;
}

RelativePose measured_motion(std::size_t from, std::size_t to, const Pose& motion) {
  RelativePose z;
  z.from = from;
  z.to = to;
  z.motion = motion;
  z.information = 100.0 * Eigen::Matrix3d::Identity();
  return z;
}

struct DrawnLog {
  std::vector<Pose> poses;
  MeasurementLog log;
};

DrawnLog drawn_log(RandomStream& random, double holes, double loops, double absolute) {
  const Pose first = drawn_pose(random, 100.0);
  DrawnLog drawn{{first}, MeasurementLog(drawn_start(random, first))};
  const auto measure = [&] {
    if (random.uniform() >= absolute) return;
    drawn.log.add_absolute(drawn_absolute(random, drawn.log.size() - 1, drawn.poses.back()));
  };
  measure();
  for (std::size_t k = 1; k < 9; ++k) {
    const Pose motion = drawn_pose(random, 1.0);
    drawn.poses.push_back(compose(drawn.poses.back(), motion));
    RelativePose step = measured_motion(k - 1, k, motion);
    step.is_hole = random.uniform() < holes;
    drawn.log.add_keyframe(step);
    for (std::size_t i = 0; i < k; ++i) {
      if (random.uniform() >= loops) continue;
      drawn.log.add_registration(measured_motion(i, k, between(drawn.poses[i], drawn.poses[k])));
    }
    measure();
    measure();
  }
  return drawn;
}

TEST(DegreesOfFreedom, AreRowsLessTheRankOfTheJacobian) {
  RandomStream random(1, "degrees of freedom");
  for (int i = 0; i < 300; ++i) {
    const double holes = 0.6 * (i % 3);
    const DrawnLog drawn = drawn_log(random, holes, 0.1 * (i % 4), 0.25 * (i % 5));
    const double expected = Jacobian(drawn.log, drawn.poses).degrees_of_freedom();
    EXPECT_EQ(degrees_of_freedom(drawn.log), expected) << "log " << i;
  }
}

std::string metre_edge(int from, int to) {
  return "EDGE_SE2 " + std::to_string(from) + " " + std::to_string(to) + " 1 0 0 1 0 0 1 0 1\n";
}

MeasurementLog without_steps(const MeasurementLog& log, std::size_t begin, std::size_t end) {
  MeasurementLog result(log.start());
  for (std::size_t k = 1; k < log.size(); ++k) {
    RelativePose step = log.arrival(k).step;
    step.is_hole = step.is_hole || (k >= begin && k < end);
    result.add_keyframe(step);
    for (const RelativePose& z : log.arrival(k).registrations) result.add_registration(z);
  }
  return result;
}

// Keyframes in a hole that no registration reaches cost nothing, and give nothing.
TEST(DegreesOfFreedom, OfKeyframesThatNothingReachesAreNone) {
  const MeasurementLog log = test::parse(metre_edge(0, 1) + metre_edge(1, 2) + metre_edge(2, 3) +
                                         metre_edge(3, 4) + metre_edge(0, 2));
  EXPECT_EQ(degrees_of_freedom(log), 3.0);
  EXPECT_EQ(determined_unknowns(log), 12.0);
  const MeasurementLog torn = without_steps(log, 3, 5);
  EXPECT_EQ(torn.hole_count(), 2U);
  EXPECT_EQ(degrees_of_freedom(torn), 3.0);
  EXPECT_EQ(determined_unknowns(torn), 6.0);
}

}  // namespace
}  // namespace fathom
