#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

/// A program ended where it should not have, or broke off what it was to say.
struct ProgramFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The words of a command line: divided by spaces, "…" and '…' keep theirs. Nothing is expanded and
/// no shell is asked. Throws InputError on a quote that is not closed.
std::vector<std::string> words_of_command(std::string_view line);

/// The file that a program's name stands for: with a `/` itself, else the first in PATH. Throws
/// EnvironmentError where there is none that may be executed.
std::string find_program(const std::string& name);

/// Another program, with pipes to its three standard streams. It works with one thread, as far as
/// the usual variables of OpenMP and BLAS say so, unless the environment has them. It belongs to
/// the process group of its caller, and is killed with this object.
class Program {
 public:
  /// Starts it. Throws EnvironmentError where the system does not.
  explicit Program(const std::vector<std::string>& words);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Writes to its standard input; what it prints meanwhile is read. Throws ProgramFailure where
  /// nobody reads any more.
  void send(std::string_view text);
  /// The next line of its standard output, awaited. Throws ProgramFailure at its end, or where it
  /// is longer than any line of numbers.
  std::string next_line();
  /// Closes its standard input and waits for its end. What is left of its output is read and
  /// forgotten. Throws ProgramFailure if it ended by a signal, or with another status than 0.
  void finish();

  /// Processor time so far, seconds, of all its threads, and of the programs that it has waited for
  /// (those in hundredths of a second until finish()).
  double processor_s() const;
  /// The largest memory that it, and after finish() any program that it waited for, had in use so
  /// far, bytes; a peak of the last milliseconds before its end may be missing.
  std::int64_t peak_bytes();

 private:
  enum Stream { input = 0, output = 1, errors = 2 };

  void close(Stream stream);
  /// Waits until something can be read, or written; reads what there is.
  bool wait_ready(bool to_write);
  void take(Stream stream);
  /// It has ended; its status is not taken.
  bool has_ended() const;
  /// Fails where it has ended and nothing more comes.
  void refuse_ended();
  /// Where it may be about to end, and to say why: reads on, and takes its status if it comes soon.
  void await_end();
  [[noreturn]] void fail(const std::string& why);
  void reap();

  std::string name_;
  int id_ = -1;
  std::array<int, 3> ends_{-1, -1, -1};
  std::string output_;
  std::size_t read_ = 0;  ///< of output_, given as lines already
  std::string errors_;
  bool is_reaped_ = false;
  int status_ = 0;
  double processor_s_ = 0.0;  ///< after its end
  std::int64_t peak_bytes_ = 0;
  std::int64_t own_bytes_ = 0;  ///< the peak of this process as it started the other
};

/// What programs did for this thread since reset_program_work(), for whoever measures cost.
struct ProgramWork {
  double waited_s = 0.0;     ///< wall time of this thread for them
  double own_s = 0.0;        ///< processor time of this thread for them
  double processor_s = 0.0;  ///< of the programs; without their start-up
  double start_up_s = 0.0;   ///< processor time of the programs until they could begin
  std::int64_t peak_bytes = 0;
};

const ProgramWork& program_work();
void reset_program_work();

/// From its making to its end this thread works for a program: what it takes is the program's, not
/// the caller's.
class ForProgram {
 public:
  ForProgram();
  ~ForProgram();
  ForProgram(const ForProgram&) = delete;
  ForProgram& operator=(const ForProgram&) = delete;

  void add_processor_s(double seconds);
  void add_start_up_s(double seconds);
  void note_peak(std::int64_t bytes);

 private:
  double wall_s_;
  double own_s_;
};

}  // namespace fathom
