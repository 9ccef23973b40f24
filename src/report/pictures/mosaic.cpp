#include "fathom/report/mosaic.hpp"

#include <algorithm>
#include <cstddef>

#include "blend.hpp"
#include "decoded_pictures.hpp"
#include "exposure.hpp"
#include "illumination.hpp"

namespace fathom {

std::vector<cv::Mat> make_mosaics(const FrameSource& source, std::span<const MosaicPlan> plans,
                                  const MosaicProgress& progress) {
  MosaicUses uses;
  std::vector<Blend> blends;
  const MosaicPlan* largest = nullptr;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    for (const PlacedPicture& place : plans[i].pictures) uses[place.frame].push_back({i, &place});
    blends.emplace_back(source.camera(), plans[i], cv::Rect({0, 0}, plans[i].size));
    if (largest == nullptr || plans[i].pictures.size() > largest->pictures.size()) {
      largest = &plans[i];
    }
  }
  if (largest == nullptr) return {};
  // The first picture may take long, where a simulated floor is drawn for it.
  if (progress) progress(0, uses.size());
  const bool has_seams = largest->blend == MosaicBlend::seams;
  DecodedPictures decoded(source, TileOptions{}.cache_bytes);
  LitPictures pictures(decoded, learnt_gain(source.camera(), decoded, largest->pictures));
  std::vector<ExposureGains> exposure;
  if (has_seams) exposure = exposure_gains(source.camera(), uses, plans, pictures);
  std::size_t done = 0;
  pictures.for_each(frames_of(uses), [&](std::size_t frame, const cv::Mat& picture) {
    for (const MosaicUse& use : uses.at(frame)) {
      blends[use.mosaic].lay(picture, *use.place,
                             has_seams ? exposure[use.mosaic].at(frame) : 1.0F);
    }
    if (progress) progress(++done, uses.size());
  });
  std::vector<cv::Mat> mosaics;
  mosaics.reserve(blends.size());
  for (Blend& blend : blends) mosaics.push_back(blend.finish());
  return mosaics;
}

}  // namespace fathom
