// fathom init: a configuration and a study for a folder of pictures, every line explained.

#include <filesystem>
#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "fathom/core/text.hpp"
#include "fathom/workflow/init.hpp"
#include "fathom/workflow/inputs.hpp"

namespace fathom {
namespace {

struct InitFlags {
  CommonFlags common;
  std::string folder;
};

void init(const InitFlags& flags, Context& context) {
  workflow::InitRequest request;
  request.survey = std::filesystem::absolute(flags.folder).lexically_normal();
  request.settings = flags.common.settings(request.survey.string());
  request.out = flags.common.folder_or(workflow::stem_of(request.survey) + "-config");
  const workflow::InitOutcome found = workflow::init(request, flags.common.estimators());
  context.status = kDone;
  if (flags.common.quiet) return;
  for (const std::string& fact : found.facts) print("%s\n", fact.c_str());
  for (const std::string& one : found.assumed) print("assumed: %s\n", one.c_str());
  for (const std::string& warning : found.warnings) print("warning: %s\n", warning.c_str());
  print("\nwrote %s\n      %s\n", found.run.c_str(), found.study.c_str());
  print("run them with: fathom run %s\n               fathom compare %s\n",
        shell_word(found.run.string()).c_str(), shell_word(found.study.string()).c_str());
}

}  // namespace

void add_init(CLI::App& program, Context& context) {
  auto flags = std::make_shared<InitFlags>();
  Command command(program, "init", "Write a configuration and a study for a folder of pictures",
                  "Example: fathom init my_survey --out my_survey_config\n"
                  "         fathom init photos --set dataset.altitude_m=2.1 "
                  "--set dataset.camera.focal_px=1850\n"
                  "Both have every key of the front end with its value and meaning.");
  command.argument("folder", flags->folder, "Folder in the EuRoC/ASL layout, or of plain pictures");
  flags->common.add_settings_to(command, context);
  flags->common.add_out_to(command, "Output folder (default: runs/FOLDER's name-config)");
  command.on_run([flags, &context] { init(*flags, context); });
}

}  // namespace fathom
