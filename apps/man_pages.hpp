#pragma once

#include <string>
#include <vector>

#include "apps/described.hpp"

namespace fathom {

/// fathom(1), in the language of man.
std::string program_page(const DescribedCommand& program,
                         const std::vector<DescribedCommand>& commands);

/// fathom-COMMAND(1).
std::string command_page(const DescribedCommand& command);

}  // namespace fathom
