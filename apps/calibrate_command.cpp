// fathom calibrate: what registrations say against dead reckoning, compass and fixes.

#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "apps/terminal.hpp"
#include "fathom/workflow/calibrate.hpp"

namespace fathom {
namespace {

struct CalibrateFlags {
  CommonFlags common;
  std::string survey;
  CacheFlags cache;
};

void calibrate(const CalibrateFlags& flags, Context& context) {
  workflow::CalibrateRequest request;
  request.settings = flags.common.settings(flags.survey);
  const std::unique_ptr<RegistrationStore> cache = flags.cache.open(flags.common.quiet);
  request.registrations = cache.get();
  Terminal terminal(flags.common.quiet);
  const workflow::CalibrateOutcome outcome =
      workflow::calibrate(request, flags.common.estimators(), terminal);
  terminal.clear();
  context.status = kDone;
  const SurveyCalibration& done = outcome.done;
  print("%zu of %zu pairs of near pictures register\n", done.found, done.tried);
  for (const std::string& fact : facts_of(done.calibration)) print("  %s\n", fact.c_str());
  if (!done.calibration.untold.empty()) print("not observable in this survey\n");
  for (const std::string& one : done.calibration.untold) print("  %s\n", one.c_str());
  for (const std::string& one : outcome.remarks) terminal.remark(one);
  for (const std::string& one : done.calibration.findings) terminal.remark(one);
  if (done.calibration.findings.empty()) {
    const bool is_compared = done.calibration.set_up || !done.calibration.turns.empty();
    print(is_compared
              ? "nothing is off by more than its standard deviation explains\n"
              : "nothing to hold them against: odometry, a compass, fixes or ground truth of "
                "a vehicle that turns\n");
  }
  terminal.print_remarks();
}

}  // namespace

void add_calibrate(CLI::App& program, Context& context) {
  auto flags = std::make_shared<CalibrateFlags>();
  Command command(program, "calibrate",
                  "Hold registrations of near pictures against dead reckoning, compass and fixes",
                  "Example: fathom calibrate my_survey\n"
                  "Says scale, mounting, handedness and clock with their standard deviations, and "
                  "what to write where one of them is off. Writes nothing.");
  command.argument("survey", flags->survey,
                   "Folder of pictures, plain or in the EuRoC/ASL layout, or configuration (YAML)");
  flags->common.add_settings_to(command, context);
  flags->cache.add_to(command);
  command.on_run([flags, &context] { calibrate(*flags, context); });
}

}  // namespace fathom
