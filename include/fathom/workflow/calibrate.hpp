#pragma once

#include "fathom/configuration/configuration.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/harness/calibrate_survey.hpp"
#include "fathom/workflow/observer.hpp"

namespace fathom::workflow {

struct CalibrateRequest {
  Settings settings;  ///< settings_of(survey), a configuration, or a study: its first cell
  RegistrationCache* registrations = nullptr;  ///< kept there, where there is one
};

struct CalibrateOutcome {
  SurveyCalibration done;
  std::vector<std::string> remarks;  ///< what the data set's files state and nobody reads
};

/// What registrations of near frames say against dead reckoning, compass and fixes. Writes nothing.
/// Throws InputError, also of a pose graph.
CalibrateOutcome calibrate(const CalibrateRequest& request, const EstimatorRegistry& registry,
                           Observer& observer);

}  // namespace fathom::workflow
