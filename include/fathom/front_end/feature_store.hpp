#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "fathom/front_end/feature_memory.hpp"
#include "fathom/front_end/registration_cache.hpp"

namespace fathom {

/// The file of a store, in the folder of the cache.
inline constexpr const char* kFeaturesFile = "features.sqlite";

/// Features of pictures on disk, shared by all commands and by several processes at once. It is
/// only a cache: a file of another version is emptied, and where it is damaged or cannot be read
/// or written, every call is a miss. May be used from several threads at once.
class FeatureStore : public FeatureCache {
 public:
  /// Makes the folder if need be. What was looked for the longest ago makes room for what is new,
  /// but nothing that this process put: beyond `most_bytes` further features are not kept.
  FeatureStore(const std::filesystem::path& folder, std::uint64_t most_bytes);
  ~FeatureStore() override;

  std::optional<PackedFeatures> find(const RegistrationKey& key) override;
  void put(const RegistrationKey& key, const PackedFeatures& features) override;

 private:
  class File;
  std::unique_ptr<File> file_;
};

}  // namespace fathom
