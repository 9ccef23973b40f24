#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fathom/front_end/registration_cache.hpp"

namespace fathom {

/// $FATHOM_CACHE, else $XDG_CACHE_HOME/fathom, else $HOME/.cache/fathom; empty where none is set.
std::filesystem::path default_cache_folder();
/// 10⁶ times $FATHOM_CACHE_MB, else 10⁹: some 400 000 registrations and the features of
/// some 1600 pictures, or fewer with rendered pictures. Throws InputError.
std::uint64_t default_cache_bytes();

/// The file of a cache, in its folder.
inline constexpr const char* kRegistrationsFile = "registrations.sqlite";

/// Registrations on disk: a file in a folder, shared by all commands and by several processes at
/// once. It is only a cache: a file of another schema version is emptied, and where
/// the file is damaged or cannot be read or written, this goes on in memory alone.
class RegistrationStore : public RegistrationCache {
 public:
  /// Opens what another one has finished, to read alone: many processes of many machines may do so
  /// at once. What is not in it is kept in memory. Throws InputError where there is none.
  static std::unique_ptr<RegistrationStore> read_only(const std::filesystem::path& folder);

  /// Of the default folder and size; features of pictures, and rendered pictures, are kept
  /// beside the registrations, half of the size for either.
  static std::unique_ptr<RegistrationStore> usual();

  /// Makes the folder if need be. An empty path: memory alone. Where the file holds more than
  /// `most_bytes` in the end (0: any number), registrations are removed, those first that were
  /// looked for the longest ago; none of those that this process put or found.
  explicit RegistrationStore(const std::filesystem::path& folder, std::uint64_t most_bytes = 0);
  /// Writes what is not yet written.
  ~RegistrationStore() override;

  std::optional<PairRegistration> find(const RegistrationKey& key) override;
  /// Written to the file with others, every second or every 200.
  void put(const RegistrationKey& key, const PairRegistration& value) override;
  PictureCache* pictures() override { return pictures_.get(); }

  /// Writes what is not yet written.
  void flush();

  /// Why the file is not used; empty where it is.
  std::string problem() const;

  /// Every registration of the file that is intact.
  std::vector<std::pair<RegistrationKey, PairRegistration>> all() const;
  /// Leaves one file that opens from a read-only folder.
  void finish();

 private:
  class File;
  explicit RegistrationStore(std::unique_ptr<File> file);

  std::unique_ptr<File> file_;
  std::unique_ptr<PictureCache> pictures_;
};

/// What a cache takes.
struct CacheContent {
  std::uint64_t registrations = 0;
  std::uint64_t pictures = 0;  ///< and sets of features
  std::uint64_t bytes = 0;     ///< of its files; 0 where there is none
};

/// Throws InputError where there is a file that is no cache.
CacheContent cache_content(const std::filesystem::path& folder);

/// Leaves nothing in it, also where other processes use it; removes a file that is damaged. Throws
/// EnvironmentError.
void clear_cache(const std::filesystem::path& folder);

/// How many registrations a merge of caches found.
struct MergedRegistrations {
  std::size_t count = 0;     ///< in the merged cache
  std::size_t repeated = 0;  ///< that several had
};

/// Makes one cache of those of several folders, and of that of `out` where there is one; it appears
/// whole or not at all. Throws InputError that names the folder where one has no cache, or another
/// registration of the same pictures by the same settings.
MergedRegistrations merge_registrations(const std::vector<std::filesystem::path>& folders,
                                        const std::filesystem::path& out);

/// Whether a folder has a cache of registrations, or of pictures and their features.
bool has_registrations(const std::filesystem::path& folder);
bool has_pictures(const std::filesystem::path& folder);

}  // namespace fathom
