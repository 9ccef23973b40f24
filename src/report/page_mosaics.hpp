#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace fathom {

/// The mosaics of a study's example, for its page (docs/report.md lists the keys): of each
/// estimator that has a `mosaic.png` in its folder the mosaic with its trajectory and loops, and
/// beside the one of `best` each of the others. Pictures are JPEG as data addresses, of at most 8
/// megapixels together. With them what was masked of every picture, where a folder has `mask.png`.
/// Null where there is none of these.
nlohmann::ordered_json page_mosaics(const std::filesystem::path& study_folder,
                                    const std::vector<std::string>& estimators,
                                    const std::optional<std::string>& best);

}  // namespace fathom
