#include "apps/terminal.hpp"

#include "apps/output.hpp"
#include "fathom/core/pin_threads.hpp"
#include "fathom/memory_meter/memory_meter.hpp"

namespace fathom {

ProgressLine& Terminal::line_of(const std::string& work) {
  if (!line_ || line_->what() != work) {
    line_.reset();
    line_.emplace(work, quiet_);
  }
  return *line_;
}

void Terminal::progress(const std::string& work, std::size_t done, std::size_t of) {
  line_of(work).show(done, of);
  if (done == of) line_.reset();
}

void Terminal::front_end_progress(const FrontEndProgress& at) {
  line_of("front end, picture").show(at);
  if (at.is_done()) line_.reset();
}

void Terminal::study_progress(const StudyProgress& at) {
  if (study_) study_->show(at);
}

void Terminal::clear() {
  line_.reset();
  study_.reset();
}

void Terminal::print_written() const {
  for (const std::string& line : written_) {
    print("%s %s\n", &line == &written_.front() ? "wrote" : "     ", line.c_str());
  }
}

void Terminal::print_remarks() const {
  for (const std::string& remark : remarks_) print("\nwarning: %s\n", remark.c_str());
}

workflow::Machine this_program() {
  return {make_memory_meter, pin_threads};
}

}  // namespace fathom
