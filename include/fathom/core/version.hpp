#pragma once

#include <string>

namespace fathom {

/// The version of Fathom.
std::string version();

}  // namespace fathom
