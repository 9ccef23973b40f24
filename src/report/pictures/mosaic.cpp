#include "fathom/report/mosaic.hpp"

#include <map>
#include <utility>

#include "blend.hpp"
#include "illumination.hpp"

namespace fathom {
namespace {

struct Use {
  std::size_t mosaic = 0;
  const PlacedPicture* place = nullptr;
};

}  // namespace

std::vector<cv::Mat> make_mosaics(const FrameSource& source, std::span<const MosaicPlan> plans,
                                  const MosaicProgress& progress) {
  std::map<std::size_t, std::vector<Use>> uses;  // by frame
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
  const cv::Mat gain = learnt_gain(source, largest->pictures);
  std::size_t done = 0;
  for (const auto& [frame, mosaics] : uses) {
    const cv::Mat picture = lit_evenly(source.image(frame), gain);
    for (const Use& use : mosaics) blends[use.mosaic].lay(picture, *use.place);
    if (progress) progress(++done, uses.size());
  }
  std::vector<cv::Mat> mosaics;
  mosaics.reserve(blends.size());
  for (Blend& blend : blends) mosaics.push_back(blend.finish());
  return mosaics;
}

}  // namespace fathom
