#include "page_mosaics.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "fathom/core/environment_error.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/picture_file.hpp"
#include "fathom/geometry/trajectory.hpp"
#include "fathom/vision/picture_codecs.hpp"
#include "fathom/vision/static_view.hpp"
#include "mosaic_raster.hpp"

namespace fathom {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// What a page of some megabytes has room for, and what a window can show of one.
constexpr double kPixelsInAll = 8e6;
constexpr double kMostPixels = 1.2e6;
constexpr std::size_t kMostPoints = 2000;

/// An estimator's files of the example.
struct Example {
  std::string name;
  MosaicRaster mosaic;
  std::vector<StampedPose> track;
  std::vector<std::pair<std::size_t, std::size_t>> loops;  ///< used; keyframes
};

std::string base64(const std::string& bytes) {
  static constexpr char kLetters[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(4 * (bytes.size() / 3 + 1));
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kLetters[group >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

std::string data_address(const cv::Mat& picture) {
  const std::vector<int> quality{cv::IMWRITE_JPEG_QUALITY, 82};
  const std::string bytes = encode_picture(".jpg", picture, quality);
  if (bytes.empty()) throw InputError("a mosaic cannot be encoded as JPEG");
  return "data:image/jpeg;base64," + base64(bytes);
}

// Used registrations of registrations.csv; what it does not say in its first three columns is
// nothing.
std::vector<std::pair<std::size_t, std::size_t>> used_loops(const fs::path& file,
                                                            std::size_t keyframes) {
  std::vector<std::pair<std::size_t, std::size_t>> loops;
  const std::string content = read_text(file);
  for (const TextLine& line : lines_of(content)) {
    const auto fields = split_csv(line.text.substr(0, kLongestRow));
    if (fields.size() < 3 || fields[2] != "used") continue;
    const auto from = parse_integer(fields[0]);
    const auto to = parse_integer(fields[1]);
    const auto is_keyframe = [&](const auto& k) {
      return k && *k >= 0 && static_cast<std::size_t>(*k) < keyframes;
    };
    if (!is_keyframe(from) || !is_keyframe(to)) continue;
    loops.emplace_back(static_cast<std::size_t>(*from), static_cast<std::size_t>(*to));
  }
  return loops;
}

// Files of another hand, or cut short, are no reason to be without a report.
std::optional<Example> read_example(const fs::path& folder, const std::string& name) {
  try {
    auto mosaic = read_mosaic(folder);
    if (!mosaic) return std::nullopt;
    Example example{name, std::move(*mosaic), read_tum(folder / "trajectory.tum"), {}};
    example.loops = used_loops(folder / "registrations.csv", example.track.size());
    return example;
  } catch (const EnvironmentError&) {
    throw;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

// Tenths of a pixel are finer than a line.
double tenths(double value) {
  return std::round(10.0 * value) / 10.0;
}

Json point(const MosaicRaster& raster, const Pose& pose) {
  const Eigen::Vector2d at = raster.pixel(pose.position());
  return {tenths(at.x()), tenths(at.y())};
}

// Every so manieth of a list, and the last.
template <class List>
List thinned(const List& list) {
  const std::size_t step = (list.size() + kMostPoints - 1) / kMostPoints;
  if (step <= 1) return list;
  List kept;
  for (std::size_t i = 0; i + 1 < list.size(); i += step) kept.push_back(list[i]);
  kept.push_back(list.back());
  return kept;
}

Json example_json(const Example& example, double most_pixels) {
  const MosaicRaster small = shrunk(example.mosaic, most_pixels);
  Json json{{"estimator", example.name},
            {"width", small.grey.cols},
            {"height", small.grey.rows},
            {"metres_per_pixel", small.metres_per_pixel},
            {"blend", example.mosaic.blend == MosaicBlend::seams ? "seams" : "feather"},
            {"loops_in_all", example.loops.size()}};
  json["path"] = Json::array();
  for (const StampedPose& pose : thinned(example.track)) {
    json["path"].push_back(point(small, pose.pose));
  }
  json["loops"] = Json::array();
  for (const auto& [from, to] : thinned(example.loops)) {
    json["loops"].push_back(
        {point(small, example.track[from].pose), point(small, example.track[to].pose)});
  }
  json["picture"] = data_address(small.grey);
  return json;
}

cv::Mat read_mask_of(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_regular_file(folder / "mask.png", error)) return {};
  try {
    return read_grey_picture(folder / "mask.png");
  } catch (const EnvironmentError&) {
    throw;
  } catch (const InputError&) {
    return {};
  }
}

// What was masked of every picture, as the first folder that has it; null: nothing.
Json mask_json(const fs::path& study_folder, const std::vector<std::string>& estimators) {
  for (const std::string& name : estimators) {
    const cv::Mat mask = read_mask_of(study_folder / name);
    if (mask.empty()) continue;
    return {{"picture", data_address(mask)},
            {"width", mask.cols},
            {"height", mask.rows},
            {"share", masked_share(mask)},
            {"where", masked_where(mask)}};
  }
  return nullptr;
}

// How far apart two estimates are, over the keyframes of the same time.
Json apart(const Example& a, const Example& b) {
  std::map<std::int64_t, Pose> poses;
  for (const StampedPose& pose : b.track) poses[pose.time_ns] = pose.pose;
  double sum_m = 0.0;
  double most_m = 0.0;
  std::size_t count = 0;
  std::size_t where = 0;
  for (std::size_t k = 0; k < a.track.size(); ++k) {
    const auto found = poses.find(a.track[k].time_ns);
    if (found == poses.end()) continue;
    const double apart_m = (a.track[k].pose.position() - found->second.position()).norm();
    sum_m += apart_m;
    ++count;
    if (apart_m < most_m) continue;
    most_m = apart_m;
    where = k;
  }
  if (count == 0) return nullptr;
  return {{"mean_m", sum_m / static_cast<double>(count)}, {"most_m", most_m}, {"keyframe", where}};
}

Json difference_json(const Example& a, const Example& b, double most_pixels) {
  const MosaicDifference difference = difference_of(a.mosaic, b.mosaic, most_pixels);
  return {{"a", a.name},
          {"b", b.name},
          {"width", difference.picture.cols},
          {"height", difference.picture.rows},
          {"metres_per_pixel", difference.frame.metres_per_pixel},
          {"common_m2", difference.common_m2},
          {"share_differs", difference.share_differs},
          {"grey_levels", kDiffers},
          {"estimates", apart(a, b)},
          {"picture", data_address(difference.picture)}};
}

}  // namespace

Json page_mosaics(const fs::path& study_folder, const std::vector<std::string>& estimators,
                  const std::optional<std::string>& best) {
  const double most_pixels =
      std::min(kMostPixels, kPixelsInAll / (2.0 * static_cast<double>(estimators.size())));
  Json json{{"mosaics", Json::array()}, {"differences", Json::array()}};
  // The best one comes first, for the others are held beside it; two mosaics are held at a time.
  std::vector<std::string> order = estimators;
  std::stable_partition(order.begin(), order.end(),
                        [&](const std::string& name) { return name == best; });
  std::optional<Example> first;
  std::map<std::string, Json> by_name;
  for (const std::string& name : order) {
    auto example = read_example(study_folder / name, name);
    if (!example) continue;
    by_name[name] = example_json(*example, most_pixels);
    if (first) {
      json["differences"].push_back(difference_json(*first, *example, most_pixels));
    } else {
      first = std::move(example);
    }
  }
  for (const std::string& name : estimators) {
    if (by_name.contains(name)) json["mosaics"].push_back(std::move(by_name[name]));
  }
  json["mask"] = mask_json(study_folder, estimators);
  if (json["mosaics"].empty() && json["mask"].is_null()) return nullptr;
  return json;
}

}  // namespace fathom
