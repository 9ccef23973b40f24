// The command line. Every command is a file of its own; input errors become one line and status 2.

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fmt/format.h>
#include <glog/logging.h>
#include <iostream>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <opencv2/core.hpp>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/out_of_memory.hpp"
#include "apps/output.hpp"
#include "apps/parse_error.hpp"
#include "fathom/core/options.hpp"
#include "fathom/core/pin_threads.hpp"
#include "fathom/core/system.hpp"
#include "fathom/core/text.hpp"
#include "fathom/core/version.hpp"

namespace fathom {
namespace {

// Ceres reports failed factorisations on standard error; here they are outcomes.
void silence_ceres() {
  FLAGS_minloglevel = google::GLOG_FATAL;
}

// As it may be typed again.
std::string joined(int argc, char** argv) {
  std::string line = "fathom";
  for (int i = 1; i < argc; ++i) line += " " + shell_word(argv[i]);
  return line;
}

// "help" and "help run" are "--help" and "run --help"; of another word the refusal is that of it.
std::vector<std::string> words_of(int argc, char** argv, const CLI::App& app) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty() || words.front() != "help") return words;
  words.erase(words.begin());
  const auto is_asked = [&](const CLI::App* one) { return one->check_name(words.front()); };
  if (words.empty() || !app.get_subcommands(is_asked).empty()) words.push_back("--help");
  return words;
}

// One line, whatever the names in it hold.
ExitStatus refused(std::string message, ExitStatus status = kBadInput) {
  while (!message.empty() && message.back() == '\n') message.pop_back();
  for (char& letter : message) {
    if (static_cast<unsigned char>(letter) < 0x20) letter = ' ';
  }
  print_error("fathom: error: %s\n", message.c_str());
  return status;
}

ExitStatus out_of_memory() {
  print_out_of_memory();
  return kFailed;
}

// Output that was lost, on a full disk for example, is no success.
int status_of_output(int status) {
  std::cout.flush();
  const bool is_lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout;
  if (is_lost) return refused("standard output cannot be written; is the disk full?");
  return std::ferror(stderr) != 0 ? static_cast<int>(kBadInput) : status;
}

int main_function(int argc, char** argv) {
  end_when_out_of_memory();
  // A file that may not grow further is an error of the write, as a full disk is.
  std::signal(SIGXFSZ, SIG_IGN);
  pin_threads();
  keep_free_memory();
  silence_ceres();
  Context context;
  context.command_line = joined(argc, argv);
  CLI::App app("Fathom: which SLAM back end should I use on my data?", "fathom");
  app.set_version_flag("--version", "fathom " + version());
  app.require_subcommand(1);
  app.footer("Each command has its own --help. Exit status: 0 done, 1 failed, 2 bad input.");
  for (const auto add :
       {add_run,      add_compare, add_solve,       add_register, add_simulate, add_evaluate,
        add_convert,  add_list,    add_import,      add_init,     add_check,    add_calibrate,
        add_report,   add_select,  add_mosaic,      add_spoil,    add_merge,    add_status,
        add_estimate, add_cache,   add_conformance, add_pages}) {
    add(app, context);
  }
  const std::vector<std::string> words = words_of(argc, argv, app);
  try {
    // The last one first, as CLI11 has them.
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const FlagError& error) {
    return refused(with_help(app, error.what()));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return refused(parse_error_text(app, error, words.empty() ? "" : words.front()));
  }
  return context.status;
}

// What is thrown on another thread arrives here, too: who starts one takes its exception along.
int status_of_main(int argc, char** argv) {
  try {
    return status_of_output(main_function(argc, argv));
  } catch (const InputError& error) {
    return refused(error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    // A name too long, a disk that is full: what the system says of a path that was given.
    return refused(error.path1().string() + ": " + error.code().message());
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  } catch (const cv::Exception& error) {
    if (error.code == cv::Error::StsNoMem) return out_of_memory();
    return refused(std::string("internal: ") + error.what(), kFailed);
  } catch (const std::system_error& error) {
    return refused("the system refused a thread: " + error.code().message(), kFailed);
  } catch (const std::exception& error) {
    return refused(std::string("internal: ") + error.what(), kFailed);
  }
}

}  // namespace
}  // namespace fathom

int main(int argc, char** argv) {
  int status = fathom::kFailed;
  try {
    status = fathom::status_of_main(argc, argv);
  } catch (...) {
    // The message of another error found no memory.
    status = fathom::out_of_memory();
  }
  return status;
}
