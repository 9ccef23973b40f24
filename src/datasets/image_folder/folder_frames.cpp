// The frames of an image folder: the rows of cam0/data.csv and the pictures that they name.

#include <cstdint>
#include <string>
#include <system_error>

#include "fathom/core/text.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "sensor_csv.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

// A name that leaves the folder would have any file of the machine read.
bool is_inside(const fs::path& name) {
  const fs::path plain = name.lexically_normal();
  return plain.is_relative() && (plain.empty() || *plain.begin() != "..");
}

}  // namespace

void ImageFolder::read_frames() {
  const SensorCsv csv(mav0_ / "cam0" / "data.csv", "timestamp, filename");
  for (const SensorRow& row : csv.rows()) {
    const fs::path picture = mav0_ / "cam0" / "data" / row.fields[1];
    if (!is_inside(row.fields[1])) {
      csv.refuse(row, "picture " + in_quotes(row.fields[1]) +
                          " is outside of cam0/data; expected a name in that folder");
    }
    std::error_code error;
    if (!fs::is_regular_file(picture, error)) {
      csv.refuse(row, "picture " + picture.string() + " is missing; add it or remove this row");
    }
    FrameInfo info;
    info.time_ns = row.time_ns;
    infos_.push_back(info);
    pictures_.push_back(picture);
  }
  refuse_other_units(csv);
}

// Pictures closer than that are none of a camera's; whole seconds are a nanosecond apart.
void ImageFolder::refuse_other_units(const SensorCsv& csv) const {
  constexpr std::int64_t kLeastIntervalNs = 1000;
  const auto intervals = static_cast<std::int64_t>(infos_.size()) - 1;
  if (intervals == 0) return;
  const std::int64_t mean_ns = (infos_.back().time_ns - infos_.front().time_ns) / intervals;
  if (mean_ns >= kLeastIntervalNs) return;
  csv.refuse(csv.rows().back(), "pictures are " + std::to_string(mean_ns) +
                                    " ns apart in the mean; are the time stamps seconds "
                                    "or milliseconds? expected nanoseconds");
}

}  // namespace fathom
