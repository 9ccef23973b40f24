#include "apps/mosaics.hpp"

#include "apps/common.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/system.hpp"
#include "fathom/report/picture.hpp"
#include "fathom/report/table.hpp"

namespace fathom {

std::vector<PlacedPicture> placed_pictures(const Recording& recording,
                                           const std::vector<Pose>& keyframes) {
  std::vector<PlacedPicture> pictures;
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    const FramePlace& place = recording.frames[i];
    const bool is_keyframe = place.time_ns == recording.keyframe_times_ns[place.keyframe];
    pictures.push_back({i, recording.frame_altitudes_m[i],
                        compose(keyframes[place.keyframe], place.motion_since_keyframe),
                        !is_keyframe});
  }
  return pictures;
}

std::vector<std::string> write_mosaics(const FrameSource& source,
                                       const std::vector<RunMosaic>& mosaics, bool quiet) {
  // Of solvers that are done: mosaics and the floor of a simulation need memory of their own.
  return_free_memory();
  MosaicOptions options;
  options.most_pixels /= static_cast<double>(mosaics.size());
  std::vector<std::string> lines;
  std::vector<MosaicPlan> plans;
  std::vector<std::filesystem::path> folders;
  for (const RunMosaic& mosaic : mosaics) {
    try {
      plans.push_back(plan_mosaic(source.camera(), mosaic.pictures, options));
      folders.push_back(mosaic.folder);
      lines.push_back("mosaic.png: " + mosaic_text(plans.back()));
    } catch (const InputError& error) {
      lines.push_back(std::string("no mosaic: ") + error.what());
    }
  }
  ProgressLine line("mosaic, picture", quiet);
  const std::vector<cv::Mat> made = make_mosaics(source, plans, line.callback());
  for (std::size_t i = 0; i < made.size(); ++i) write_mosaic(folders[i], plans[i], made[i]);
  return lines;
}

void write_mosaic(const std::filesystem::path& folder, const MosaicPlan& plan,
                  const cv::Mat& mosaic) {
  write_file(folder / "mosaic.png", encode_png(mosaic));
  write_file(folder / "mosaic.json", mosaic_json(plan));
}

std::string mosaic_text(const MosaicPlan& plan) {
  std::string text = std::to_string(plan.pictures.size()) + " pictures, " +
                     std::to_string(plan.size.width) + " x " + std::to_string(plan.size.height) +
                     " pixels of " + format_number(plan.metres_per_pixel, 4) + " m";
  if (plan.metres_per_pixel > plan.wanted_metres_per_pixel) {
    text += "; of " + format_number(plan.wanted_metres_per_pixel, 4) + " m they would be too many";
  }
  return text;
}

}  // namespace fathom
