#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fathom/datasets/frame_source.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/report/earth_frame.hpp"
#include "fathom/report/mosaic.hpp"
#include "fathom/workflow/observer.hpp"

namespace fathom::workflow {

/// A mosaic that `run` or `compare` writes into the folder of a run.
struct RunMosaic {
  std::filesystem::path folder;
  std::vector<PlacedPicture> pictures;
};

/// Every frame where an estimate has it; those between keyframes are fillers.
std::vector<PlacedPicture> placed_pictures(const Recording& recording,
                                           const std::vector<Pose>& keyframes);

/// Writes `mosaic.png`, `mosaic.pgw` and `mosaic.json` of each, with seams, on Earth also
/// `mosaic.tif`, all together no larger than one may be. What has no mosaic, such as an estimate
/// gone wild, gets none: a run is worth keeping without. Returns for each one line of what was
/// written, or why it was not.
std::vector<std::string> write_mosaics(const FrameSource& source,
                                       const std::vector<RunMosaic>& mosaics,
                                       const EarthFrame* earth, Observer& observer);

/// A single mosaic, as it is asked for.
struct AskedMosaic {
  std::optional<double> metres_per_pixel;  ///< as in MosaicOptions
  const EarthFrame* earth = nullptr;       ///< on Earth also `mosaic.tif`
  MosaicBlend blend = MosaicBlend::feather;
};

/// Writes `mosaic.png`, `mosaic.pgw` and `mosaic.json`. Throws InputError. Returns what was laid.
std::string write_mosaic(const std::filesystem::path& folder, const FrameSource& source,
                         const std::vector<PlacedPicture>& pictures, const AskedMosaic& asked,
                         Observer& observer);

/// The same of a mosaic that may be larger than memory: `tiles/`, each tile with its world file,
/// and `mosaic.json`.
std::string write_tiled_mosaic(const std::filesystem::path& folder, const FrameSource& source,
                               const std::vector<PlacedPicture>& pictures, const AskedMosaic& asked,
                               int tile_px, Observer& observer);

/// All names that a mosaic may have.
std::vector<std::string> mosaic_file_names();

/// "57 pictures, 2310 x 1780 pixels of 0.0041 m", and why they are coarser than wanted.
std::string mosaic_text(const MosaicPlan& plan);

}  // namespace fathom::workflow
