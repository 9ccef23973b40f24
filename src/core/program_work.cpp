#include <algorithm>
#include <chrono>

#include "fathom/core/program.hpp"
#include "fathom/core/workers.hpp"

namespace fathom {
namespace {

thread_local ProgramWork work;

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

const ProgramWork& program_work() {
  return work;
}

void reset_program_work() {
  work = {};
}

ForProgram::ForProgram() : wall_s_(wall_seconds()), own_s_(thread_processor_seconds()) {}

ForProgram::~ForProgram() {
  work.waited_s += wall_seconds() - wall_s_;
  work.own_s += thread_processor_seconds() - own_s_;
}

void ForProgram::add_processor_s(double seconds) {
  work.processor_s += seconds;
}

void ForProgram::add_start_up_s(double seconds) {
  work.start_up_s += seconds;
}

void ForProgram::note_peak(std::int64_t bytes) {
  work.peak_bytes = std::max(work.peak_bytes, bytes);
}

}  // namespace fathom
