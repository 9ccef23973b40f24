#pragma once

#include <optional>
#include <string>

#include "apps/flags.hpp"
#include "fathom/workflow/known_estimators.hpp"

namespace fathom {

/// The exit status of a command.
enum ExitStatus : int { kDone = 0, kFailed = 1, kBadInput = 2, kStopped = 130 };

/// What all commands share.
struct Context {
  std::string command_line;  ///< as typed, for the manifest
  int status = kDone;        ///< set by the command that ran

  /// Those built in, those of the plug-ins that FATHOM_PLUGIN_PATH names, and those loaded since.
  /// Throws InputError of that path, the first time.
  workflow::KnownEstimators& estimators();

 private:
  std::optional<workflow::KnownEstimators> estimators_;
};

// Each adds its subcommand to the command line.
void add_run(CLI::App& program, Context& context);
void add_compare(CLI::App& program, Context& context);
void add_solve(CLI::App& program, Context& context);
void add_register(CLI::App& program, Context& context);
void add_simulate(CLI::App& program, Context& context);
void add_evaluate(CLI::App& program, Context& context);
void add_convert(CLI::App& program, Context& context);
void add_list(CLI::App& program, Context& context);
void add_import(CLI::App& program, Context& context);
void add_init(CLI::App& program, Context& context);
void add_calibrate(CLI::App& program, Context& context);
void add_check(CLI::App& program, Context& context);
void add_report(CLI::App& program, Context& context);
void add_mosaic(CLI::App& program, Context& context);
void add_select(CLI::App& program, Context& context);
void add_spoil(CLI::App& program, Context& context);
void add_merge(CLI::App& program, Context& context);
void add_estimate(CLI::App& program, Context& context);
void add_status(CLI::App& program, Context& context);
void add_cache(CLI::App& program, Context& context);
void add_conformance(CLI::App& program, Context& context);
void add_pages(CLI::App& program, Context& context);

}  // namespace fathom
