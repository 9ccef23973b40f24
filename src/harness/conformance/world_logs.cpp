#include "world_logs.hpp"

namespace fathom::conformance {

Eigen::Matrix2d fix_covariance(double sigma_m) {
  Eigen::Matrix2d C;
  C << 1.0, 0.4, 0.4, 2.0;
  return sigma_m * sigma_m * C;
}

MeasurementLog in_world(const MeasurementLog& plain, std::span<const Pose> truth,
                        const WorldOptions& options) {
  RandomStream random(options.seed, "world");
  MeasurementLog log(options.start);
  const auto is_due = [](std::size_t k, std::size_t every) { return every > 0 && k % every == 0; };
  for (std::size_t k = 0; k < plain.size(); ++k) {
    if (k > 0) log.add_keyframe(plain.arrival(k).step);
    for (const RelativePose& z : plain.arrival(k).registrations) log.add_registration(z);
    const Pose& X = truth[k];
    if (is_due(k, options.heading_every)) {
      const double error = options.noise * options.heading_sigma_rad * random.normal();
      log.add_absolute(AbsolutePose::heading(k, X.theta + error, options.heading_sigma_rad));
    }
    if (is_due(k, options.position_every)) {
      const double sigma = options.noise * options.position_sigma_m;
      const Eigen::Vector2d error(sigma * random.normal(), sigma * random.normal());
      log.add_absolute(AbsolutePose::position(k, X.position() + error,
                                              fix_covariance(options.position_sigma_m)));
    }
    if (is_due(k, options.pose_every)) {
      const Pose measured = perturbed(X, options.noise * options.position_sigma_m,
                                      options.noise * options.heading_sigma_rad, random);
      log.add_absolute(AbsolutePose::from_covariance(
          k, measured, full_covariance(options.position_sigma_m, options.heading_sigma_rad)));
    }
  }
  log.ids = plain.ids;
  return log;
}

MeasurementLog circle_in_world(const WorldOptions& options, LogOptions plain) {
  plain.origin = options.start.pose;
  return in_world(circle_log(plain), circle(plain.keyframes, plain.origin), options);
}

StartPose uncertain_start(const Pose& pose, double sigma_m, double sigma_rad) {
  StartPose start(pose);
  start.covariance = full_covariance(sigma_m, sigma_rad);
  return start;
}

}  // namespace fathom::conformance
