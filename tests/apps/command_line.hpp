#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <sys/types.h>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/temporary_folder.hpp"

namespace fathom::test {

/// What a command left: its exit status (128 + signal if one ended it) and what it printed.
struct Ended {
  int status = -1;
  std::string out;
  std::string err;
};

/// Standard error behind the notes that it begins with.
std::string without_notes(std::string errors);

/// What the program finds where it is started.
struct Surroundings {
  std::filesystem::path program = FATHOM_BINARY;
  std::map<std::string, std::string> environment;  ///< beside what the test itself has
  std::string standard_output;                     ///< a file in place of what `Ended` holds
  std::size_t address_space_bytes = 0;             ///< at most; 0: no bound
  unsigned processor_s = 0;                        ///< likewise
  std::size_t file_bytes = 0;                      ///< of a file, likewise
};

/// Runs the real program in a new folder of the test's own.
class CommandLine : public ::testing::Test {
 protected:
  using Arguments = std::vector<std::string>;

  /// `while_running` is called with the process id, again and again, until the program has ended.
  Ended fathom(const Arguments& arguments,
               const std::function<void(pid_t)>& while_running = {}) const;

  /// As above, and the program must succeed, with notes alone on standard error.
  Ended fathom_done(const Arguments& arguments) const;

  /// The program must refuse its input: status 2, nothing on standard output, one line
  /// `fathom: error: …` on standard error, behind notes if there are any, and not a file more or
  /// less than before. Returns what stands after `fathom: error: `.
  std::string refusal(const Arguments& arguments) const;

  /// Writes a file of the folder and returns its name.
  std::string write(const std::string& name, const std::string& content) const;

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  nlohmann::json json_of(const std::string& name) const;
  /// Everything in the folder, relative to it.
  std::set<std::string> tree() const;

  Surroundings surroundings_;

 private:
  TemporaryFolder folder_;
};

}  // namespace fathom::test
