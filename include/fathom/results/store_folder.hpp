#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fathom/results/result_store.hpp"

namespace fathom {

/// The store of a study while it runs, in a folder of its own. Where nothing was stored nothing is
/// left behind.
class StoreFolder {
 public:
  /// As ResultStore::write.
  StoreFolder(const std::filesystem::path& folder, const StudyDescription& study,
              const std::string& manifest);
  ~StoreFolder();
  StoreFolder(const StoreFolder&) = delete;
  StoreFolder& operator=(const StoreFolder&) = delete;

  ResultStore& store() { return *store_; }

 private:
  bool is_empty() const;

  std::filesystem::path folder_;
  bool is_new_folder_;
  bool is_new_;
  std::optional<ResultStore> store_;
};

}  // namespace fathom
