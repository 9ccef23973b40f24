#pragma once

#include <optional>

#include "fathom/front_end/pair_registrar.hpp"

namespace fathom {

/// Standard deviations of what pictures share that the survey's own loops gave, in place of those
/// that its registrations were made with (CovarianceOptions, estimated).
struct EstimatedSigmas {
  std::optional<double> altitude_m;  ///< of altitudes whose sensor states none
  std::optional<double> tilt_rad;    ///< of pictures without measured roll and pitch

  std::optional<double> own_factor;  ///< of the registration's own standard deviations

  bool is_empty() const { return !altitude_m && !tilt_rad && !own_factor; }

  /// A registration that was found, with these.
  PairRegistration told(PairRegistration found, const MeasuredFrame& from,
                        const MeasuredFrame& to) const;
};

}  // namespace fathom
