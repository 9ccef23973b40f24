#pragma once

#include <memory>
#include <optional>
#include <string>

#include "fathom/front_end/registration_store.hpp"

namespace fathom {

/// The registrations kept in a folder, of "" in the default one; nothing without a folder.
std::unique_ptr<RegistrationStore> recording_cache(const std::optional<std::string>& folder);

}  // namespace fathom
