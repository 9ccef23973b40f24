#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "fathom/front_end/registration_cache.hpp"

namespace fathom {

/// $FATHOM_CACHE, else $XDG_CACHE_HOME/fathom, else $HOME/.cache/fathom; empty where none is set.
std::filesystem::path default_cache_folder();

/// Registrations on disk: `registrations.sqlite` in a folder, shared by all studies and by several
/// processes at once. It is only a cache: a file of another schema version is emptied, and where
/// the file is damaged or cannot be read or written, this goes on in memory alone.
class RegistrationStore : public RegistrationCache {
 public:
  /// Makes the folder if need be. An empty path: memory alone.
  explicit RegistrationStore(const std::filesystem::path& folder);
  /// Writes what is not yet written.
  ~RegistrationStore() override;

  std::optional<PairRegistration> find(const RegistrationKey& key) override;
  /// Written to the file with others, every second or every 200.
  void put(const RegistrationKey& key, const PairRegistration& value) override;

  /// Writes what is not yet written.
  void flush();

  /// Why the file is not used; empty where it is.
  std::string problem() const;

 private:
  class File;

  std::unique_ptr<File> file_;
};

}  // namespace fathom
