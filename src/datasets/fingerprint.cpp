#include "fathom/datasets/fingerprint.hpp"

#include <algorithm>
#include <cstdio>

#include "fathom/core/files.hpp"
#include "fathom/core/hash.hpp"

namespace fathom {
namespace {

std::string hex(std::uint64_t value) {
  char buffer[17];
  std::snprintf(buffer, sizeof buffer, "%016llx", static_cast<unsigned long long>(value));
  return buffer;
}

}  // namespace

Fingerprint fingerprint(const std::vector<std::filesystem::path>& files,
                        const std::stop_token& stop) {
  Fingerprint hashes;
  for (const std::filesystem::path& path : files) {
    if (stop.stop_requested()) break;
    hashes.emplace_back(path.string(), hex(Hash().add("file").add(read_file(path)).value()));
  }
  std::ranges::sort(hashes);
  return hashes;
}

std::string fingerprint_text(const Fingerprint& files) {
  Hash hash;
  for (const auto& [file, content] : files) hash.add(file).add(content);
  return hex(hash.value());
}

}  // namespace fathom
