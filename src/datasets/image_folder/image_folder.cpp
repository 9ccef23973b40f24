#include "fathom/datasets/image_folder.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "attitude_series.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/datasets/asl_files.hpp"
#include "fathom/datasets/camera_doubts.hpp"
#include "fathom/datasets/picture_file.hpp"
#include "near_folders.hpp"
#include "reading_outliers.hpp"
#include "sensor_series.hpp"
#include "sensor_yaml.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

fs::path mav0_of(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) throw InputError(path.string(), "is no folder");
  for (const fs::path& candidate : {path / "mav0", path}) {
    if (fs::is_directory(candidate / "cam0", error)) return candidate;
  }
  const fs::path inner = path / "mav0";
  throw InputError(path.string(),
                   std::string(fs::is_empty(path, error) ? "is empty" : "has no mav0/cam0") +
                       "; expected a folder in the EuRoC/ASL layout, or pictures with "
                       "dataset.type: pictures" +
                       near_folder_hint(fs::is_directory(inner, error) ? inner : path, "cam0"));
}

// The sensor's data.csv if its folder is there. A folder without one is a mistake, not an absence.
std::optional<fs::path> sensor_csv(const fs::path& mav0, const std::string& sensor) {
  std::error_code error;
  if (!fs::exists(mav0 / sensor, error)) return std::nullopt;
  return mav0 / sensor / "data.csv";
}

SensorYaml yaml_beside(const fs::path& csv) {
  return read_sensor_yaml(csv.parent_path() / "sensor.yaml");
}

[[noreturn]] void refuse_uncovered(const fs::path& csv, const TimeLine& times,
                                   const std::string& what, const FrameInfo& info) {
  throw InputError(
      csv.string(),
      fmt::format("no {} at or around the picture's time {} ns: there are {}; expected neighbours "
                  "at most 2 s apart, or remove the picture's row{}",
                  what, info.time_ns, times.text(),
                  what == "odometry" ? ", or dataset.gap_intervals, which makes holes" : ""));
}

}  // namespace

ImageFolder::ImageFolder(const fs::path& path, const OdometryGaps& gaps) : mav0_(mav0_of(path)) {
  const fs::path camera_file = mav0_ / "cam0" / "sensor.yaml";
  camera_ = read_camera_yaml(camera_file);
  remarks_ = camera_doubts(camera_.model(), camera_file.string());
  if (const fs::path mask = mav0_ / "cam0" / "mask.png"; fs::exists(mask)) {
    mask_ = read_mask(mask, {camera_.model().width, camera_.model().height});
  }
  read_frames();
  const TimeSpan recorded{infos_.front().time_ns, infos_.back().time_ns};
  read_altitudes();
  read_attitude();
  read_odometry(gaps);
  read_ground_truth();
  sensors_ = read_folder_sensors(mav0_, {infos_.front().time_ns, infos_.back().time_ns}, recorded);
  std::ranges::copy(leave_out_contradicted(sensors_, infos_), std::back_inserter(remarks_));
  std::ranges::copy(unread_folders(mav0_), std::back_inserter(remarks_));
  std::ranges::copy(unread_sensor_keys(mav0_), std::back_inserter(remarks_));
  remark(hidden_pictures_remark(pictures_.front().parent_path()));
  ids_ = FileIds(pictures_.size());
  ImageFolder::image(0);  // refuses what cannot be read before a run starts
}

// A clock that is put right leaves pictures at one end without a reading.
void ImageFolder::leave_out_uncovered(const TimeLine& times, const fs::path& csv) {
  if (yaml_beside(csv).time_offset_ns == 0) return;
  const std::int64_t last_ns = times.at(times.size() - 1);
  std::vector<FrameInfo> infos;
  std::vector<fs::path> pictures;
  for (std::size_t i = 0; i < infos_.size(); ++i) {
    if (infos_[i].time_ns < times.at(0) || infos_[i].time_ns > last_ns) continue;
    infos.push_back(infos_[i]);
    pictures.push_back(pictures_[i]);
  }
  if (infos.size() == infos_.size()) return;
  const std::string sensor = csv.parent_path().filename().string();
  if (infos.empty()) {
    throw InputError(csv.string(), "no picture is at its time, with the time_offset_s of " +
                                       sensor + "/sensor.yaml");
  }
  remarks_.push_back(fmt::format(
      "{} of {} pictures are left out: with its time_offset_s {} begins after them or ends before",
      infos_.size() - infos.size(), infos_.size(), sensor));
  infos_ = std::move(infos);
  pictures_ = std::move(pictures);
}

void ImageFolder::remark(std::optional<std::string> text) {
  if (text) remarks_.push_back(std::move(*text));
}

void ImageFolder::read_altitudes() {
  const auto csv = sensor_csv(mav0_, "altimeter0");
  if (!csv) {
    throw InputError(mav0_.string(),
                     "has no altimeter0/data.csv; without altitude pixels cannot become metres" +
                         near_folder_hint(mav0_, "altimeter0"));
  }
  const SensorYaml yaml = yaml_beside(*csv);
  const AltitudeSeries altimeter(*csv, yaml);
  altimeter_scale_ = yaml.scale;
  leave_out_uncovered(altimeter.times(), *csv);
  remark(altimeter.remark());
  for (FrameInfo& info : infos_) {
    const auto found = altimeter.at(info.time_ns, kMaxInterpolationGapNs);
    if (!found) refuse_uncovered(*csv, altimeter.times(), "altitude", info);
    info.altitude_m = found->altitude_m;
    const double stated_m =
        std::hypot(yaml.scale * yaml.sigma_absolute, yaml.sigma_relative * info.altitude_m);
    info.altitude_sigma_m = std::hypot(stated_m, found->sigma_m);
  }
}

void ImageFolder::read_attitude() {
  const auto csv = sensor_csv(mav0_, "attitude0");
  if (!csv) return;
  const AttitudeSeries attitude(*csv, yaml_beside(*csv));
  leave_out_uncovered(attitude.times(), *csv);
  remark(attitude.remark());
  for (FrameInfo& info : infos_) {
    info.tilt = attitude.at(info.time_ns, kMaxInterpolationGapNs);
    if (!info.tilt) refuse_uncovered(*csv, attitude.times(), "roll and pitch", info);
    try {
      camera_.footprint(info.stance());
    } catch (const InputError& error) {
      throw InputError(csv->string(),
                       fmt::format("at the picture's time {} ns {}; expected a picture of the "
                                   "floor alone, or remove the picture's row",
                                   info.time_ns, error.what()));
    }
  }
}

void ImageFolder::read_odometry(const OdometryGaps& gaps) {
  const auto csv = sensor_csv(mav0_, "odometry0");
  if (!csv) return;
  OdometrySeries odometry(*csv, yaml_beside(*csv));
  leave_out_uncovered(odometry.times(), *csv);
  std::ranges::copy(odometry.mend(gaps.declared.speed_limit_m_s), std::back_inserter(remarks_));
  odometry.make_holes(gaps, infos_.front().time_ns, infos_.back().time_ns);
  for (std::size_t i = 0; i < infos_.size(); ++i) {
    if (!odometry.covers(infos_[i].time_ns, kMaxInterpolationGapNs)) {
      refuse_uncovered(*csv, odometry.times(), "odometry", infos_[i]);
    }
    if (i == 0) continue;
    infos_[i].motion = odometry.motion(infos_[i - 1].time_ns, infos_[i].time_ns);
    infos_[i].is_hole = odometry.has_hole(infos_[i - 1].time_ns, infos_[i].time_ns);
  }
  odometry_ = odometry.recorded();
  has_odometry_ = true;
}

void ImageFolder::read_ground_truth() {
  const auto csv = sensor_csv(mav0_, "state_groundtruth_estimate0");
  if (!csv) return;
  const PoseSeries truth(*csv, yaml_beside(*csv).time_offset_ns);
  for (FrameInfo& info : infos_) {
    info.ground_truth = truth.at(info.time_ns, kMaxInterpolationGapNs);
  }
  has_ground_truth_ = std::ranges::all_of(
      infos_, [](const FrameInfo& info) { return info.ground_truth.has_value(); });
}

std::vector<fs::path> ImageFolder::files() const {
  std::vector<fs::path> files = pictures_;
  for (const auto& sensor : fs::directory_iterator(mav0_)) {
    for (const char* name : {"data.csv", "sensor.yaml", "mask.png"}) {
      const fs::path file = sensor.path() / name;
      std::error_code error;
      if (fs::is_regular_file(file, error)) files.push_back(file);
    }
  }
  std::ranges::sort(files);
  return files;
}

cv::Mat ImageFolder::image(std::size_t i) const {
  const CameraModel& model = camera_.model();
  return read_grey_picture(
      pictures_[i], {model.width, model.height},
      fmt::format("expected the resolution of sensor.yaml, {} x {}", model.width, model.height));
}

std::uint64_t ImageFolder::picture_id(std::size_t i) const {
  return ids_.of(i, pictures_[i]);
}

}  // namespace fathom
