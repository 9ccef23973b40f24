#pragma once

#include <string>

#include "fathom/vision/registration.hpp"

namespace fathom {

/// What `fathom register` prints: the verdict, and the numbers that it rests on. Several lines,
/// each with its end.
std::string registration_text(const FloorFeatures& a, const FloorFeatures& b,
                              const RegistrationOptions& options, const Registration& registration);

}  // namespace fathom
