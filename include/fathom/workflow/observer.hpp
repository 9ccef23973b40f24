#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "fathom/harness/recording.hpp"
#include "fathom/harness/replay.hpp"
#include "fathom/harness/study_run.hpp"

namespace fathom::workflow {

/// Hears what a use case has to say as it goes on. Who overrides nothing hears nothing. What a
/// function throws ends the work; what is written already stays.
class Observer {
 public:
  virtual ~Observer();

  /// `work` ("ekf, keyframe") has come to step `done` of `of`.
  virtual void progress(const std::string& work, std::size_t done, std::size_t of);
  virtual void front_end_progress(const FrontEndProgress& at);
  /// On any thread, one at a time.
  virtual void study_progress(const StudyProgress& at);
  /// What looks wrong with the data or the result, a sentence.
  virtual void remark(const std::string& text);
  /// A file is in its place, or why it is not; a path, or a line that begins with the file's name.
  virtual void wrote(const std::string& line);

  /// progress() of this work, as a callback. This must outlive it.
  Progress progress_of(std::string work);
};

/// What a program lends to the work that is done for it.
struct Machine {
  /// A meter of memory for the thread that calls; none: memory is not measured.
  std::function<std::unique_ptr<MemoryMeter>()> make_meter;
  /// Called on every thread before its first work: pins the threads of BLAS and the like.
  std::function<void()> on_thread_start;
};

}  // namespace fathom::workflow
