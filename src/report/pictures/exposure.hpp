#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "fathom/report/mosaic.hpp"
#include "illumination.hpp"

namespace fathom {

/// Where a picture lies in one of several mosaics.
struct MosaicUse {
  std::size_t mosaic = 0;
  const PlacedPicture* place = nullptr;
};

/// By frame.
using MosaicUses = std::map<std::size_t, std::vector<MosaicUse>>;

/// The frames of them, in order.
std::vector<std::size_t> frames_of(const MosaicUses& uses);

/// By frame, the factor that makes its picture agree in grey with those that it overlaps.
using ExposureGains = std::map<std::size_t, float>;

/// Those of each plan: least squares of log grey over the cells of a coarse floor (docs/mosaic.md).
/// Each picture is asked for once, in the order of frames. Memory: some 10 KB for each use.
std::vector<ExposureGains> exposure_gains(const Camera& camera, const MosaicUses& uses,
                                          std::span<const MosaicPlan> plans, LitPictures& pictures);

}  // namespace fathom
