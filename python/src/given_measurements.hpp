#pragma once

#include <vector>

#include "fathom/estimation/estimator.hpp"

namespace fathom {

/// Measurements as Python is given them: it may keep them beyond the call.
struct GivenMeasurements {
  explicit GivenMeasurements(const Measurements& given)
      : registrations(given.registrations.begin(), given.registrations.end()),
        absolute(given.absolute.begin(), given.absolute.end()) {}

  std::vector<RelativePose> registrations;
  std::vector<AbsolutePose> absolute;
};

}  // namespace fathom
