#include "python/src/work.hpp"

#include "python/src/one_thread.hpp"
#include "python/src/solution.hpp"

namespace fathom {

void InterruptibleWork::progress(const std::string& /*work*/, std::size_t /*done*/,
                                 std::size_t /*of*/) {
  check_signals();
}

void InterruptibleWork::front_end_progress(const FrontEndProgress& /*at*/) {
  check_signals();
}

workflow::Machine this_process() {
  return {nullptr, OneThread::pin_this_thread};
}

std::unique_ptr<RegistrationStore> registrations_in(const std::optional<std::string>& folder) {
  if (!folder) return nullptr;
  if (folder->empty()) return RegistrationStore::usual();
  return std::make_unique<RegistrationStore>(*folder);
}

}  // namespace fathom
