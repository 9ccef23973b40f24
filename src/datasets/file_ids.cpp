#include "fathom/datasets/file_ids.hpp"

#include "fathom/core/files.hpp"
#include "fathom/core/hash.hpp"

namespace fathom {

std::uint64_t FileIds::of(std::size_t i, const std::filesystem::path& file) const {
  std::uint64_t known = ids_[i].load();
  if (known != 0) return known;
  const std::uint64_t id = Hash().add("picture file").add(read_file(file)).value();
  return ids_[i].compare_exchange_strong(known, id) ? id : known;
}

}  // namespace fathom
