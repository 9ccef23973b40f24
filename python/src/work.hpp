#pragma once

#include <memory>
#include <optional>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

#include "fathom/front_end/registration_store.hpp"
#include "fathom/workflow/observer.hpp"

namespace fathom {

/// Ctrl-C ends the work at its next keyframe; remarks are kept.
class InterruptibleWork : public workflow::Observer {
 public:
  /// `heard` is of Python and outlives this; it is called with a dict of stage, step and steps,
  /// unless it is None. What it throws ends the work.
  explicit InterruptibleWork(const pybind11::object& heard) : heard_(heard) {}

  void progress(const std::string& work, std::size_t done, std::size_t of) override;
  void front_end_progress(const FrontEndProgress& at) override;
  void remark(const std::string& text) override { remarks.push_back(text); }

  std::vector<std::string> remarks;

 private:
  const pybind11::object& heard_;
};

/// What this process lends. Its allocator counts nothing.
workflow::Machine this_process();

/// The registrations kept in a folder, of "" in the default one; nothing without a folder.
std::unique_ptr<RegistrationStore> registrations_in(const std::optional<std::string>& folder);

}  // namespace fathom
