#pragma once

#include <memory>
#include <span>

#include "fathom/measurements/variance_components.hpp"

namespace fathom::test {

inline void set_sigmas(PictureErrors& errors, std::size_t k,
                       std::span<const VarianceComponent> components,
                       std::span<const double> sigmas) {
  for (std::size_t j = 0; j < components.size(); ++j) {
    if (!components[j].is_of_pictures() ||
        (!components[j].governed.empty() && !components[j].governed[k]))
      continue;
    if (components[j].part == VarianceComponent::Part::altitude) {
      errors.sigma[0] = sigmas[j];
    } else {
      errors.sigma.tail<2>().setConstant(sigmas[j]);
    }
  }
}

inline RelativePose with_sigmas(RelativePose z, std::span<const VarianceComponent> components,
                                std::span<const double> sigmas) {
  if (!z.shared) return z;
  SharedErrors shared = *z.shared;
  set_sigmas(shared.from, z.from, components, sigmas);
  set_sigmas(shared.to, z.to, components, sigmas);
  for (std::size_t j = 0; j < components.size(); ++j) {
    if (!components[j].is_of_pictures()) shared.own *= 1.0 + sigmas[j] * sigmas[j];
  }
  if (shared == *z.shared) return z;
  z.information = RelativePose::from_covariance(z.from, z.to, z.motion, shared.total()).information;
  z.shared = std::make_shared<const SharedErrors>(shared);
  return z;
}

/// The log with one σ a component in all its registrations, and their information that of the new
/// total; all else to the last bit.
inline MeasurementLog with_sigmas(const MeasurementLog& log,
                                  std::span<const VarianceComponent> components,
                                  std::span<const double> sigmas) {
  MeasurementLog changed(log.start());
  for (std::size_t k = 0; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    if (k > 0) changed.add_keyframe(arrival.step);
    for (const RelativePose& z : arrival.registrations) {
      changed.add_registration(with_sigmas(z, components, sigmas));
    }
    for (const AbsolutePose& z : arrival.absolute) changed.add_absolute(z);
  }
  changed.ids = log.ids;
  changed.guess = log.guess;
  return changed;
}

}  // namespace fathom::test
