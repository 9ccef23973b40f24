#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace fathom {

/// The exit status of a command.
enum ExitStatus : int { kDone = 0, kFailed = 1, kBadInput = 2, kStopped = 130 };

/// What all commands share.
struct Context {
  std::string command_line;  ///< as typed, for the manifest
  int status = kDone;        ///< set by the command that ran
};

// Each adds its subcommand to the command line.
void add_run(CLI::App& app, Context& context);
void add_compare(CLI::App& app, Context& context);
void add_solve(CLI::App& app, Context& context);
void add_register(CLI::App& app, Context& context);
void add_simulate(CLI::App& app, Context& context);
void add_evaluate(CLI::App& app, Context& context);
void add_list(CLI::App& app, Context& context);
void add_check(CLI::App& app, Context& context);
void add_report(CLI::App& app, Context& context);
void add_mosaic(CLI::App& app, Context& context);
void add_select(CLI::App& app, Context& context);
void add_spoil(CLI::App& app, Context& context);

}  // namespace fathom
