#include "odometry_restarts.hpp"

#include <algorithm>

namespace fathom {

std::vector<std::size_t> odometry_restarts(const std::vector<OdometryReading>& readings,
                                           double factor) {
  constexpr double kBackShare = 0.1;
  constexpr double kUsualShare = 0.99;
  struct Return {
    std::size_t reading = 0;
    double speed = 0.0;  // metres a nanosecond
  };
  std::vector<Return> returns;
  std::vector<double> usual;
  for (std::size_t i = 1; i < readings.size(); ++i) {
    const Eigen::Vector2d first = readings.front().message.position.head<2>();
    const Eigen::Vector2d from = readings[i - 1].message.position.head<2>();
    const Eigen::Vector2d to = readings[i].message.position.head<2>();
    const double speed =
        (to - from).norm() / static_cast<double>(readings[i].time_ns - readings[i - 1].time_ns);
    if ((to - first).norm() <= kBackShare * (from - first).norm() && from != first) {
      returns.push_back({i, speed});
    } else {
      usual.push_back(speed);
    }
  }
  if (usual.empty()) return {};
  const auto rank =
      static_cast<std::ptrdiff_t>(kUsualShare * static_cast<double>(usual.size() - 1));
  std::ranges::nth_element(usual, usual.begin() + rank);
  const double limit = factor * usual[static_cast<std::size_t>(rank)];
  std::vector<std::size_t> restarts;
  for (const Return& step : returns) {
    if (step.speed > limit) restarts.push_back(step.reading);
  }
  return restarts;
}

}  // namespace fathom
