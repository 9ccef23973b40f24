#pragma once

#include <string>
#include <vector>

namespace fathom::test {

/// The files below these folders of the checkout whose names match a regular expression; folders
/// and files are named from the top of the checkout.
std::vector<std::string> files_below(const std::vector<std::string>& folders,
                                     const std::string& name_pattern);

/// Of a file of the checkout, named from its top; empty where there is none.
std::string content_of(const std::string& file);

}  // namespace fathom::test
