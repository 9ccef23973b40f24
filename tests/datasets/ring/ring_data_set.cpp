// A data set for docs/extending.md: a ring of poses of which the last sees the first.

#include <cmath>
#include <memory>
#include <numbers>

#include "fathom/datasets/data_set.hpp"

namespace fathom {
namespace {

struct RingOptions {
  int poses = 12;
  double radius_m = 5.0;

  void describe(OptionTable& table) {
    table.integer("poses", poses, Range::at_least(3), "", "poses on the ring");
    table.real("radius_m", radius_m, Range::positive(), "m", "radius of the ring");
  }
};

class Ring : public DataSet {
 public:
  explicit Ring(const RingOptions& options) {
    const double turn_rad = 2.0 * std::numbers::pi / options.poses;
    const double chord_m = 2.0 * options.radius_m * std::sin(turn_rad / 2.0);
    const Pose step{chord_m * std::cos(turn_rad / 2.0), chord_m * std::sin(turn_rad / 2.0),
                    turn_rad};
    const Eigen::Matrix3d covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
    const auto last = static_cast<std::size_t>(options.poses) - 1;
    for (std::size_t k = 1; k <= last; ++k) {
      log_.add_keyframe(RelativePose::from_covariance(k - 1, k, step, covariance));
    }
    log_.add_registration(RelativePose::from_covariance(last, 0, step, covariance));
  }

  const MeasurementLog* graph() const override { return &log_; }

 private:
  MeasurementLog log_;
};

}  // namespace

DataSetEntry ring_data_set() {
  DataSetEntry entry = make_data_set<RingOptions>(
      "ring", "a ring of poses of which the last sees the first",
      [](const RingOptions& options, std::uint64_t) { return std::make_unique<Ring>(options); });
  entry.is_graph = true;
  return entry;
}

}  // namespace fathom
