#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "fathom/front_end/registration_cache.hpp"

namespace fathom {

/// The file of a store, in the folder of the cache.
inline constexpr const char* kPicturesFile = "features.sqlite";

/// Features of pictures, and rendered pictures, on disk, shared by all commands and by several
/// processes at once. It is only a cache: a file of another version is emptied, and where it is
/// damaged or cannot be read or written, every call is a miss. May be used from several threads at
/// once.
class PictureStore : public PictureCache {
 public:
  /// Makes the folder if need be. What was looked for the longest ago makes room for what is new,
  /// but nothing that this process put: beyond `most_bytes` nothing further is kept.
  PictureStore(const std::filesystem::path& folder, std::uint64_t most_bytes);
  ~PictureStore() override;

  std::optional<std::string> find(const RegistrationKey& key) override;
  void put(const RegistrationKey& key, std::string_view bytes) override;

 private:
  class File;
  std::unique_ptr<File> file_;
};

}  // namespace fathom
