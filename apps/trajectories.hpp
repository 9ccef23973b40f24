#pragma once

#include <string>
#include <vector>

#include "apps/flags.hpp"
#include "fathom/core/options.hpp"
#include "fathom/geometry/plane.hpp"
#include "fathom/geometry/trajectory_file.hpp"

namespace fathom {

/// The value of a name of a list of names; throws InputError with the flag and all names.
template <class Value>
Value named(const std::string& flag, const std::string& name,
            const std::vector<std::pair<std::string, Value>>& names) {
  std::vector<std::string> all;
  for (const auto& [word, value] : names) {
    if (word == name) return value;
    all.push_back(word);
  }
  throw InputError(flag + ": " + not_one_of(name, all));
}

/// How a trajectory is to be read, as flags say it.
struct TrajectoryFlags {
  std::string format;  ///< empty: by its content
  std::string plane;   ///< empty: the usual one of its format
  std::string times;   ///< of a KITTI trajectory

  SpatialTrajectory read(const std::string& path, const std::string& format_flag) const;
};

/// "x to y s".
std::string span_text(const SpatialTrajectory& trajectory);

}  // namespace fathom
