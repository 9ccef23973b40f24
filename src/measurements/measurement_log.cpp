#include "fathom/measurements/measurement_log.hpp"

#include <algorithm>
#include <cassert>

#include "fathom/geometry/trajectory.hpp"

namespace fathom {

void MeasurementLog::add_keyframe(const RelativePose& step) {
  assert(step.newest() == size() && step.from + step.to + 1 == 2 * size());
  measurements_.push_back({step, {}, {}});
}

void MeasurementLog::add_registration(const RelativePose& registration) {
  assert(size() > 1 && registration.newest() + 1 == size());
  measurements_.back().registrations.push_back(registration);
}

void MeasurementLog::add_absolute(const AbsolutePose& measurement) {
  assert(measurement.keyframe + 1 == size());
  measurements_.back().absolute.push_back(measurement);
}

std::size_t MeasurementLog::registration_count() const {
  std::size_t count = 0;
  for (const KeyframeMeasurements& arrival : measurements_) count += arrival.registrations.size();
  return count;
}

std::size_t MeasurementLog::absolute_count() const {
  std::size_t count = 0;
  for (const KeyframeMeasurements& arrival : measurements_) count += arrival.absolute.size();
  return count;
}

bool MeasurementLog::tells_shared_errors() const {
  return std::ranges::any_of(measurements_, [](const KeyframeMeasurements& arrival) {
    return std::ranges::any_of(arrival.registrations,
                               [](const RelativePose& z) { return z.shared != nullptr; });
  });
}

std::size_t MeasurementLog::hole_count() const {
  return static_cast<std::size_t>(
      std::count_if(measurements_.begin() + 1, measurements_.end(),
                    [](const KeyframeMeasurements& arrival) { return arrival.step.is_hole; }));
}

std::vector<RelativePose> MeasurementLog::edges() const {
  std::vector<RelativePose> edges;
  for (std::size_t k = 1; k < size(); ++k) {
    const KeyframeMeasurements& arrival = measurements_[k];
    if (!arrival.step.is_hole) edges.push_back(arrival.step);
    edges.insert(edges.end(), arrival.registrations.begin(), arrival.registrations.end());
  }
  return edges;
}

std::vector<Pose> MeasurementLog::odometry() const {
  std::vector<Pose> motions;
  for (std::size_t k = 1; k < size(); ++k) {
    motions.push_back(measurements_[k].step.forward().motion);
  }
  return compose_trajectory(origin(), motions);
}

MeasurementLog with_registrations(
    const MeasurementLog& log,
    const std::function<RelativePose(const RelativePose&, std::size_t)>& change) {
  MeasurementLog changed(log.start());
  std::size_t count = 0;
  for (std::size_t k = 0; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    if (k > 0) changed.add_keyframe(arrival.step);
    for (const AbsolutePose& z : arrival.absolute) changed.add_absolute(z);
    for (const RelativePose& z : arrival.registrations) {
      changed.add_registration(change(z, count));
      ++count;
    }
  }
  changed.ids = log.ids;
  changed.guess = log.guess;
  changed.self_edges = log.self_edges;
  return changed;
}

double chi2(const MeasurementLog& log, std::span<const Pose> trajectory) {
  assert(trajectory.size() == log.size());
  double sum = absolute_chi2(log, trajectory);
  for (std::size_t k = 1; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    if (!arrival.step.is_hole) {
      sum += chi2(arrival.step, trajectory[arrival.step.from], trajectory[arrival.step.to]);
    }
    for (const RelativePose& z : arrival.registrations) {
      sum += chi2(z, trajectory[z.from], trajectory[z.to]);
    }
  }
  return sum;
}

double absolute_chi2(const MeasurementLog& log, std::span<const Pose> trajectory) {
  double sum = 0.0;
  if (!log.start().is_fixed()) sum += chi2(log.start().measurement(), trajectory[0]);
  for (std::size_t k = 0; k < log.size(); ++k) {
    for (const AbsolutePose& z : log.arrival(k).absolute) sum += chi2(z, trajectory[k]);
  }
  return sum;
}

}  // namespace fathom
