#include "fathom/workflow/calibrate.hpp"

#include "fathom/configuration/study.hpp"

namespace fathom::workflow {

CalibrateOutcome calibrate(const CalibrateRequest& request, const EstimatorRegistry& registry,
                           Observer& observer) {
  const Configuration configuration =
      kind_of(request.settings) == ConfigurationKind::single
          ? configure(request.settings, ConfigurationKind::single, registry)
          : configure_study(request.settings, registry).cells.front();
  const auto pictures = std::make_shared<Pictures>(configuration, request.registrations);
  Survey survey(pictures, configuration, {static_cast<std::uint64_t>(configuration.seed), 0});
  return {
      calibrate_survey(survey, configuration.front_end, observer.progress_of("calibrate, pair")),
      pictures->data().remarks()};
}

}  // namespace fathom::workflow
