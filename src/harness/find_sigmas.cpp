#include "find_sigmas.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "fathom/harness/recording_facts.hpp"

namespace fathom {
namespace {

using Part = VarianceComponent::Part;

std::vector<VarianceComponent> unknown_components(const Recording& recording,
                                                  const FrameSource& measured,
                                                  const CovarianceOptions& options) {
  std::vector<VarianceComponent> components;
  if (!options.altitude_sigma_m) {
    VarianceComponent altitude{Part::altitude};
    for (const std::size_t frame : recording.keyframe_frames) {
      altitude.least.push_back(measured.info(frame).altitude_sigma_m);
    }
    components.push_back(altitude);
  }
  if (!options.tilt_sigma_rad) {
    VarianceComponent tilt{Part::tilt};
    for (const std::size_t frame : recording.keyframe_frames) {
      tilt.governed.push_back(!measured.info(frame).tilt);
    }
    if (std::ranges::count(tilt.governed, true) > 0) components.push_back(tilt);
  }
  if (!options.own_factor) components.push_back({Part::own});
  return components;
}

double assumed(Part part, const CovarianceOptions& options) {
  if (part == Part::tilt) return options.tilt();
  return part == Part::altitude ? options.altitude() : options.own();
}

// σ of the component as its option has it.
double in_option(Part part, double sigma) {
  return part == Part::own ? std::hypot(1.0, sigma) : sigma;
}

bool is_done(VarianceEstimate::Outcome outcome) {
  return outcome == VarianceEstimate::Outcome::converged ||
         outcome == VarianceEstimate::Outcome::iteration_limit;
}

}  // namespace

std::vector<FoundSigma> find_sigmas(const Recording& recording, const FrameSource& measured,
                                    const CovarianceOptions& options,
                                    const EstimatorRegistry& registry) {
  const auto components = unknown_components(recording, measured, options);
  if (components.empty()) return {};
  VarianceEstimate estimate;
  if (recording.log.registration_count() > 0) {
    const auto optimum = batch_optimum(recording.log, registry);
    estimate = estimate_variance(recording.log, optimum ? optimum->poses : recording.log.odometry(),
                                 components);
  }
  std::vector<FoundSigma> found;
  for (std::size_t i = 0; i < components.size(); ++i) {
    FoundSigma sigma;
    sigma.part = components[i].part;
    sigma.in_force = assumed(sigma.part, options);
    sigma.registrations = estimate.registrations;
    if (is_done(estimate.outcome)) {
      sigma.contradicted = static_cast<std::size_t>(std::ranges::count(estimate.used, false));
      const SigmaEstimate& of_part = estimate.components[i];
      sigma.is_found = of_part.is_determined();
      sigma.low = in_option(sigma.part, of_part.low);
      sigma.high = in_option(sigma.part, of_part.high);
      if (sigma.is_found) sigma.in_force = in_option(sigma.part, of_part.sigma);
    }
    found.push_back(sigma);
  }
  return found;
}

EstimatedSigmas sigmas_of(const std::vector<FoundSigma>& found) {
  EstimatedSigmas sigmas;
  for (const FoundSigma& sigma : found) {
    if (!sigma.is_found) continue;
    switch (sigma.part) {
      case Part::altitude:
        sigmas.altitude_m = sigma.in_force;
        break;
      case Part::tilt:
        sigmas.tilt_rad = sigma.in_force;
        break;
      case Part::own:
        sigmas.own_factor = sigma.in_force;
        break;
    }
  }
  return sigmas;
}

std::string words(const FoundSigma& sigma) {
  const bool is_factor = sigma.part == Part::own;
  const std::string name = is_factor                  ? "own errors of registrations"
                           : sigma.part == Part::tilt ? "roll and pitch"
                                                      : "altitude";
  const std::string unit = is_factor                  ? " times what residuals show"
                           : sigma.part == Part::tilt ? " mrad"
                                                      : " mm";
  const auto value = [is_factor](double number) {
    return fmt::format("{:.3g}", is_factor ? number : 1e3 * number);
  };
  if (!sigma.is_found) {
    return fmt::format("{}: {}{}, assumed: {} loops do not tell", name, value(sigma.in_force), unit,
                       sigma.registrations);
  }
  std::string text = fmt::format("{}: {}{} [{}, {}], from {} loops", name, value(sigma.in_force),
                                 unit, value(sigma.low), value(sigma.high), sigma.registrations);
  if (sigma.contradicted > 0) {
    text += fmt::format(", {} that the others contradict left out", sigma.contradicted);
  }
  return text;
}

}  // namespace fathom
