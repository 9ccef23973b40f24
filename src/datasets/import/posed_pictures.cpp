#include "fathom/core/text.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/picture_folder.hpp"
#include "pose_table.hpp"

namespace fathom {

std::unique_ptr<const FrameSource> open_pictures_of(const std::filesystem::path& survey,
                                                    std::vector<std::string>& notes) {
  if (!is_plain_picture_folder(survey)) return std::make_unique<ImageFolder>(survey);
  PictureFolderOptions options;
  options.path = survey.string();
  // Neither is looked at.
  options.altitude_m = 1.0;
  options.focal_px = 1.0;
  auto pictures = std::make_unique<PictureFolder>(options);
  if (!pictures->has_own_times()) {
    notes.push_back(
        "the pictures have no times of their own, of EXIF, that rise: the reference is "
        "for dataset.interval_s " +
        short_number(options.interval_s) + ", the default");
  }
  return pictures;
}

}  // namespace fathom
