#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fathom/datasets/frame_source.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/report/mosaic.hpp"

namespace fathom {

/// A mosaic that `run` or `compare` writes into the folder of a run.
struct RunMosaic {
  std::filesystem::path folder;
  std::vector<PlacedPicture> pictures;
};

/// Every frame where an estimate has it; those between keyframes are fillers.
std::vector<PlacedPicture> placed_pictures(const Recording& recording,
                                           const std::vector<Pose>& keyframes);

/// Writes `mosaic.png` and `mosaic.json` of each, all together no larger than one may be. What has
/// no mosaic, such as an estimate gone wild, gets none: a run is worth keeping without. Returns for
/// each one line of what was written, or why it was not.
std::vector<std::string> write_mosaics(const FrameSource& source,
                                       const std::vector<RunMosaic>& mosaics, bool quiet);

/// Writes `mosaic.png` and `mosaic.json`.
void write_mosaic(const std::filesystem::path& folder, const MosaicPlan& plan,
                  const cv::Mat& mosaic);

/// "57 pictures, 2310 x 1780 pixels of 0.0041 m", and why they are coarser than wanted.
std::string mosaic_text(const MosaicPlan& plan);

}  // namespace fathom
