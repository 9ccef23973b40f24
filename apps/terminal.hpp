#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/progress.hpp"
#include "fathom/workflow/observer.hpp"

namespace fathom {

/// What work has to say, on the terminal: its progress as it goes on, files and remarks when they
/// are asked for, after the command's own lines.
class Terminal : public workflow::Observer {
 public:
  explicit Terminal(bool quiet) : quiet_(quiet), study_(std::in_place, quiet) {}

  void progress(const std::string& work, std::size_t done, std::size_t of) override;
  void front_end_progress(const FrontEndProgress& at) override;
  void study_progress(const StudyProgress& at) override;
  void remark(const std::string& text) override { remarks_.push_back(text); }
  void wrote(const std::string& line) override { written_.push_back(line); }

  /// Takes progress away: the work is done, and the command prints.
  void clear();
  /// "wrote runs/a/trajectory.png", and all others below it.
  void print_written() const;
  /// "warning: …" after an empty line, each.
  void print_remarks() const;

 private:
  ProgressLine& line_of(const std::string& work);

  bool quiet_;
  std::optional<ProgressLine> line_;  ///< of the work that goes on
  std::optional<StudyProgressLine> study_;
  std::vector<std::string> written_;
  std::vector<std::string> remarks_;
};

/// What this program lends: a meter of memory, threads that are pinned.
workflow::Machine this_program();

}  // namespace fathom
