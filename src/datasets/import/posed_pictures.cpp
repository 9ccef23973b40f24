#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/picture_folder.hpp"
#include "pose_table.hpp"

namespace fathom {

std::unique_ptr<const FrameSource> open_pictures_of(const std::filesystem::path& survey) {
  if (!is_plain_picture_folder(survey)) return std::make_unique<ImageFolder>(survey);
  PictureFolderOptions options;
  options.path = survey.string();
  // Neither is looked at.
  options.altitude_m = 1.0;
  options.focal_px = 1.0;
  return std::make_unique<PictureFolder>(options);
}

}  // namespace fathom
