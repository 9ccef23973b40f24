#include "python/src/work.hpp"

#include "python/src/one_thread.hpp"
#include "python/src/solution.hpp"

namespace fathom {

void InterruptibleWork::progress(const std::string& work, std::size_t done, std::size_t of) {
  check_signals();
  if (heard_.is_none()) return;
  const pybind11::gil_scoped_acquire lock;
  heard_(pybind11::dict(pybind11::arg("stage") = work, pybind11::arg("step") = done,
                        pybind11::arg("steps") = of));
}

void InterruptibleWork::front_end_progress(const FrontEndProgress& at) {
  progress("front end, picture", at.pictures, at.of_pictures);
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
