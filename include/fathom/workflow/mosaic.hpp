#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fathom/configuration/config_file.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/report/mosaic.hpp"
#include "fathom/workflow/observer.hpp"

namespace fathom::workflow {

/// The pictures of a run, laid where a trajectory has them.
struct MosaicRequest {
  std::filesystem::path run;  ///< folder of a run over pictures
  /// In place of the run's own, of `dataset.…` and `seed` alone.
  Settings settings;
  std::filesystem::path trajectory;        ///< TUM; empty: the run's own estimate of all frames
  std::optional<double> metres_per_pixel;  ///< as in MosaicOptions
  double max_difference_s = 0.01;          ///< between the stamps of a pose and its picture
  std::optional<int> tile_px;              ///< tiles in place of one picture
  MosaicBlend blend = MosaicBlend::feather;
  /// Empty: `runs/` and the names of run and trajectory. A run's folder takes a mosaic of its own
  /// estimate alone, and keeps its map files.
  std::filesystem::path out;
};

struct MosaicOutcome {
  std::size_t with_pose = 0;  ///< frames
  std::size_t frames = 0;
  std::string laid;  ///< "57 pictures, 2310 x 1780 pixels of 0.0041 m"
};

/// Writes the mosaic and the map files beside it (docs/outputs.md). Throws InputError.
MosaicOutcome mosaic(const MosaicRequest& request, const EstimatorRegistry& registry,
                     Observer& observer);

}  // namespace fathom::workflow
