#include "fathom/measurements/measurement_log.hpp"

#include <cassert>

#include "fathom/geometry/trajectory.hpp"

namespace fathom {

void MeasurementLog::add_keyframe(const RelativePose& step) {
  assert(step.newest() == size() && step.from + step.to + 1 == 2 * size());
  measurements_.push_back({step, {}});
}

void MeasurementLog::add_registration(const RelativePose& registration) {
  assert(!measurements_.empty() && registration.newest() + 1 == size());
  measurements_.back().registrations.push_back(registration);
}

std::size_t MeasurementLog::registration_count() const {
  std::size_t count = 0;
  for (const KeyframeMeasurements& arrival : measurements_) count += arrival.registrations.size();
  return count;
}

std::vector<RelativePose> MeasurementLog::edges() const {
  std::vector<RelativePose> edges;
  for (const KeyframeMeasurements& arrival : measurements_) {
    edges.push_back(arrival.step);
    edges.insert(edges.end(), arrival.registrations.begin(), arrival.registrations.end());
  }
  return edges;
}

std::vector<Pose> MeasurementLog::odometry() const {
  std::vector<Pose> motions;
  for (const KeyframeMeasurements& arrival : measurements_) {
    motions.push_back(arrival.step.forward().motion);
  }
  return compose_trajectory(origin_, motions);
}

double chi2(const MeasurementLog& log, std::span<const Pose> trajectory) {
  assert(trajectory.size() == log.size());
  double sum = 0.0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    sum += chi2(arrival.step, trajectory[arrival.step.from], trajectory[arrival.step.to]);
    for (const RelativePose& z : arrival.registrations) {
      sum += chi2(z, trajectory[z.from], trajectory[z.to]);
    }
  }
  return sum;
}

}  // namespace fathom
