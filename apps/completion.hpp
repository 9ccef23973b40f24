#pragma once

#include <map>
#include <string>
#include <vector>

#include "apps/described.hpp"

namespace fathom {

/// The words that may stand for a value, by its name in --help: "METRIC".
using WordsOfValues = std::map<std::string, std::vector<std::string>>;

/// A script that bash reads: commands, flags, files, folders and the values that are known.
std::string bash_completion(const DescribedCommand& program,
                            const std::vector<DescribedCommand>& commands,
                            const WordsOfValues& known);

}  // namespace fathom
