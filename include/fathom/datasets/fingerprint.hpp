#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace fathom {

/// Files, each with the hash of its content in hexadecimal digits.
using Fingerprint = std::vector<std::pair<std::string, std::string>>;

/// Of the files of a data set, sorted by name: the same list means the same data. Reads every file.
/// Throws InputError. Once `stop` is asked for it ends, with those it has.
Fingerprint fingerprint(const std::vector<std::filesystem::path>& files,
                        const std::stop_token& stop = {});

/// One hash of all of them.
std::string fingerprint_text(const Fingerprint& files);

}  // namespace fathom
