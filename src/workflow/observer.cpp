#include "fathom/workflow/observer.hpp"

#include <utility>

namespace fathom::workflow {

Observer::~Observer() = default;

void Observer::progress(const std::string& /*work*/, std::size_t /*done*/, std::size_t /*of*/) {}

void Observer::front_end_progress(const FrontEndProgress& /*at*/) {}

void Observer::study_progress(const StudyProgress& /*at*/) {}

void Observer::remark(const std::string& /*text*/) {}

void Observer::wrote(const std::string& /*line*/) {}

Progress Observer::progress_of(std::string work) {
  return [this, work = std::move(work)](std::size_t done, std::size_t of) {
    progress(work, done, of);
  };
}

}  // namespace fathom::workflow
