#pragma once

#include <span>
#include <string>
#include <string_view>

namespace fathom {

/// What a build can do beyond the program itself, where its packages are found
/// (cmake/FathomFeatures.cmake).
struct Feature {
  std::string_view name;  ///< such as "geotiff"; the CMake option is FATHOM_GEOTIFF
  bool is_built = false;
  std::string_view gives;
  std::string_view packages;  ///< of Debian, with blanks between
  std::string_view group;     ///< `scripts/build.sh GROUP` installs them, "none": nothing does
};

/// All that this Fathom knows of, built or not.
std::span<const Feature> features();

/// Of that name. Throws std::out_of_range for a name of none.
const Feature& feature(std::string_view name);

/// What gets the feature: the command "scripts/build.sh import", or the page that says how.
std::string remedy_for(const Feature& feature);

/// What the message says that refuses something for want of a feature: "this Fathom was built
/// without libfastcdr-dev; 'scripts/build.sh import' installs it and builds again", or "…; see
/// docs/adapters.md".
std::string refusal_without(std::string_view name);

}  // namespace fathom
