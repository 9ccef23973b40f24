#include "find_sigmas.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <span>

#include "fathom/front_end/pair_registrar.hpp"
#include "fathom/harness/recording_facts.hpp"

namespace fathom {
namespace {

using Part = VarianceComponent::Part;

constexpr double kMostOfAltitude = 0.1;
constexpr double kMostTiltRad = 0.2;
constexpr double kMostOwn = 30.0;
constexpr double kMostContradicted = 0.1;  // of all loops

std::vector<VarianceComponent> unknown_components(const Recording& recording,
                                                  const FrameSource& measured,
                                                  const CovarianceOptions& options) {
  std::vector<VarianceComponent> components;
  const auto add = [&](Part part, const auto& is_stated) {
    VarianceComponent component{part};
    for (const std::size_t frame : recording.keyframe_frames) {
      component.governed.push_back(!is_stated(measured.info(frame)));
    }
    if (std::ranges::count(component.governed, true) > 0) components.push_back(component);
  };
  if (!options.altitude_sigma_m) {
    add(Part::altitude, [](const FrameInfo& frame) { return frame.altitude_sigma_m > 0.0; });
  }
  if (!options.tilt_sigma_rad) {
    add(Part::tilt, [](const FrameInfo& frame) { return frame.tilt.has_value(); });
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

void put_in_force(EstimatedSigmas& sigmas, Part part, double value) {
  switch (part) {
    case Part::altitude:
      sigmas.altitude_m = value;
      break;
    case Part::tilt:
      sigmas.tilt_rad = value;
      break;
    case Part::own:
      sigmas.own_factor = value;
      break;
  }
}

EstimatedSigmas in_force(const std::vector<VarianceComponent>& components,
                         std::span<const double> by_loops) {
  EstimatedSigmas sigmas;
  for (std::size_t i = 0; i < components.size(); ++i) {
    put_in_force(sigmas, components[i].part, in_option(components[i].part, by_loops[i]));
  }
  return sigmas;
}

bool is_done(VarianceEstimate::Outcome outcome) {
  return outcome == VarianceEstimate::Outcome::converged ||
         outcome == VarianceEstimate::Outcome::iteration_limit;
}

bool is_contradicted(const FoundSigma& sigma) {
  return static_cast<double>(sigma.contradicted) >
         kMostContradicted * static_cast<double>(sigma.contradicted + sigma.registrations);
}

// What no altimeter and no vehicle has.
bool is_beyond(const FoundSigma& sigma, double altitude_m) {
  if (sigma.part == Part::altitude) return sigma.by_loops > kMostOfAltitude * altitude_m;
  return sigma.by_loops > (sigma.part == Part::tilt ? kMostTiltRad : kMostOwn);
}

double mean_altitude(const Recording& recording, const FrameSource& measured) {
  double sum = 0.0;
  for (const std::size_t frame : recording.keyframe_frames) sum += measured.info(frame).altitude_m;
  return sum / static_cast<double>(recording.keyframe_frames.size());
}

std::string name_of(const FoundSigma& sigma) {
  if (sigma.part == Part::own) return "own errors of registrations";
  return sigma.part == Part::tilt ? "roll and pitch" : "altitude";
}

std::string value_of(const FoundSigma& sigma, double number) {
  return fmt::format("{:.3g}", sigma.part == Part::own ? number : 1e3 * number);
}

std::string unit_of(const FoundSigma& sigma) {
  if (sigma.part == Part::own) return " times what residuals show";
  return sigma.part == Part::tilt ? " mrad" : " mm";
}

std::string by_loops(const FoundSigma& sigma) {
  return fmt::format("{}{} [{}, {}]", value_of(sigma, sigma.by_loops), unit_of(sigma),
                     value_of(sigma, sigma.low), value_of(sigma, sigma.high));
}

// One that is beyond all reason explains away what is wrong, and takes the others with it.
void refuse_implausible(std::vector<FoundSigma>& found, const CovarianceOptions& options,
                        double altitude_m) {
  const std::string wrong = "focal length, altitudes, mounting, clocks or dead reckoning are wrong";
  std::string of;
  for (FoundSigma& sigma : found) {
    if (!sigma.is_found()) continue;
    if (is_contradicted(sigma)) {
      sigma.refusal =
          fmt::format("{} of {} loops contradict the others: {}, or loops are", sigma.contradicted,
                      sigma.contradicted + sigma.registrations, wrong);
    } else if (is_beyond(sigma, altitude_m)) {
      sigma.refusal = fmt::format("by {} loops {}, more than any vehicle has: {}",
                                  sigma.registrations, by_loops(sigma), wrong);
    }
    if (!sigma.is_found()) of = name_of(sigma);
  }
  if (of.empty()) return;
  for (FoundSigma& sigma : found) {
    sigma.in_force = assumed(sigma.part, options);
    if (sigma.is_found()) sigma.refusal = "as " + of + " is not plausible";
  }
}

}  // namespace

bool are_assumed_too_small(const EstimatedSigmas& sigmas, const CovarianceOptions& options) {
  return sigmas.own_factor > 1.0 && sigmas.tilt_rad > options.tilt();
}

std::vector<FoundSigma> find_sigmas(const Recording& recording, const FrameSource& measured,
                                    const CovarianceOptions& options,
                                    const EstimatorRegistry& registry, bool with_intervals) {
  const auto components = unknown_components(recording, measured, options);
  if (components.empty()) return {};
  VarianceEstimate estimate;
  if (recording.log.registration_count() > 0) {
    const auto optimum = batch_optimum(recording.log, registry);
    VarianceOptions of_pictures;  // the threads that registered them
    of_pictures.threads = static_cast<int>(PairRegistrar::look_ahead());
    if (!with_intervals) {
      of_pictures.wants_intervals = [&](std::span<const double> by_loops) {
        return !are_assumed_too_small(in_force(components, by_loops), options);
      };
    }
    estimate = estimate_variance(recording.log, optimum ? optimum->poses : recording.log.odometry(),
                                 components, of_pictures);
  }
  std::vector<FoundSigma> found;
  for (std::size_t i = 0; i < components.size(); ++i) {
    FoundSigma sigma;
    sigma.part = components[i].part;
    sigma.in_force = assumed(sigma.part, options);
    sigma.registrations = estimate.registrations;
    sigma.refusal = fmt::format("{} loops do not tell", sigma.registrations);
    if (is_done(estimate.outcome)) {
      const SigmaEstimate& of_part = estimate.components[i];
      sigma.contradicted = static_cast<std::size_t>(std::ranges::count(estimate.used, false));
      sigma.by_loops = in_option(sigma.part, of_part.sigma);
      sigma.low = in_option(sigma.part, of_part.low);
      sigma.high = in_option(sigma.part, of_part.high);
      if (of_part.is_determined()) {
        sigma.refusal.clear();
        sigma.in_force = sigma.by_loops;
      }
    }
    found.push_back(sigma);
  }
  refuse_implausible(found, options, mean_altitude(recording, measured));
  return found;
}

EstimatedSigmas sigmas_of(const std::vector<FoundSigma>& found) {
  EstimatedSigmas sigmas;
  for (const FoundSigma& sigma : found) {
    if (sigma.is_found()) put_in_force(sigmas, sigma.part, sigma.in_force);
  }
  return sigmas;
}

std::string words(const FoundSigma& sigma) {
  if (!sigma.is_found()) {
    return fmt::format("{}: {}{} assumed: {}", name_of(sigma), value_of(sigma, sigma.in_force),
                       unit_of(sigma), sigma.refusal);
  }
  std::string text =
      fmt::format("{}: {}, from {} loops", name_of(sigma), by_loops(sigma), sigma.registrations);
  if (sigma.contradicted > 0) {
    text += fmt::format(", {} that the others contradict left out", sigma.contradicted);
  }
  return text;
}

}  // namespace fathom
