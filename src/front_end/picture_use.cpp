#include "fathom/front_end/picture_use.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <span>

#include <opencv2/core/utility.hpp>

#include "fathom/core/environment_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/vision/features.hpp"
#include "fathom/vision/static_view.hpp"
#include "motion_chain.hpp"

namespace fathom {
namespace {

/// So many pictures are looked at: a place that keeps its content has a correlation of 1, one that
/// does not, by chance, at most 0.2 (docs/front_end.md#what-stays-in-place).
constexpr std::size_t kLooked = 16;

cv::Mat detail_or_nothing(const FrameSource& frames, std::size_t frame) {
  try {
    return detail_of_view(frames.image(frame));
  } catch (const EnvironmentError&) {
    throw;
  } catch (const InputError&) {
    return {};  // who needs the picture is told
  }
}

// Of every other one of `count` frames that are spread over the survey, from `first` on.
void add_details(const FrameSource& frames, std::size_t first, std::size_t count,
                 std::vector<cv::Mat>& details) {
  std::vector<cv::Mat> more((count - first + 1) / 2);
  cv::parallel_for_({0, static_cast<int>(more.size())}, [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const std::size_t at = first + 2 * static_cast<std::size_t>(i);
      more[static_cast<std::size_t>(i)] =
          detail_or_nothing(frames, (2 * at + 1) * frames.size() / (2 * count));
    }
  });
  std::erase_if(more, [](const cv::Mat& detail) { return detail.empty(); });
  details.insert(details.end(), more.begin(), more.end());
}

// Half of the pictures tell of most surveys that nothing stays.
StaticView static_view_of(const FrameSource& frames) {
  const std::size_t count = std::min(kLooked, frames.size());
  if (count == 0) return {};
  std::vector<cv::Mat> details;
  add_details(frames, 0, count, details);
  if (!may_have_static_view(details)) return {};
  add_details(frames, 1, count, details);
  const CameraModel& model = frames.camera().model();
  return find_static_view(details, {model.width, model.height});
}

std::optional<std::uint64_t> identity(const FrameSource& frames, std::size_t frame) {
  try {
    return frames.picture_id(frame);
  } catch (const EnvironmentError&) {
    throw;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

// Whether dead reckoning, if there is any, has the vehicle move by pixels, and is sure of it.
bool has_moved(const UncertainPose& motion, const Camera& camera, double altitude_m) {
  constexpr double kPixels = 3.0;
  constexpr double kSigmas = 5.0;
  const CameraModel& model = camera.model();
  const double pixel_m = metres_per_pixel(model, altitude_m);
  const double half_m = 0.5 * pixel_m * std::hypot(model.width, model.height);
  const double moved_m = motion.mean.position().norm() + half_m * std::abs(motion.mean.theta);
  const double variance =
      motion.covariance.topLeftCorner<2, 2>().trace() + half_m * half_m * motion.covariance(2, 2);
  return moved_m > kPixels * pixel_m && moved_m > kSigmas * std::sqrt(variance);
}

// Of frames first + 1 … last, whose pictures are all that of the first.
bool moved_in(const FrameSource& frames, std::size_t first, std::size_t last) {
  MotionChain chain;
  for (std::size_t i = first + 1; i <= last; ++i) {
    if (!frames.info(i).motion) return true;
    chain.append(frames.info(i));
  }
  return has_moved(chain.motion(), frames.camera(), frames.info(first).altitude_m);
}

std::string mask_remark(const PictureUse& use) {
  const char* const how = "front_end.mask: off switches that off";
  if (use.is_given) {
    return fmt::format("masked: {:.2g} % of the picture ({}), as the data set says; {}",
                       100.0 * masked_share(use.mask), masked_where(use.mask), how);
  }
  return fmt::format(
      "masked: {:.2g} % of the picture ({}), which stay in place while the vehicle moves: a part "
      "of "
      "the vehicle, text or dirt; no feature there is matched; {}",
      100.0 * masked_share(use.mask), masked_where(use.mask), how);
}

}  // namespace

std::vector<bool> repeated_pictures(const FrameSource& frames) {
  std::vector<bool> repeats;
  std::optional<std::uint64_t> of_first;
  std::size_t first = 0;
  const auto close = [&](std::size_t end) {
    if (end - first < 2 || !moved_in(frames, first, end - 1)) return;
    repeats.resize(frames.size(), false);
    for (std::size_t i = first + 1; i < end; ++i) repeats[i] = true;
  };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto id = identity(frames, i);
    if (id && id == of_first) continue;
    close(i);
    of_first = id;
    first = i;
  }
  close(frames.size());
  return repeats;
}

PictureUse picture_use(const FrameSource& frames, MaskUse use) {
  PictureUse found;
  found.repeats = repeated_pictures(frames);
  if (use == MaskUse::off) return found;
  const cv::Mat given = frames.given_mask();
  if (!given.empty()) {
    found.is_given = masked_share(given) > 0.0;
    if (found.is_given) found.mask = given;
    return found;
  }
  const StaticView view = static_view_of(frames);
  found.mask = view.mask;
  found.is_told = view.is_told || frames.size() < kLooked;
  return found;
}

std::vector<std::string> remarks_on(const PictureUse& use, const FrameSource& frames) {
  std::vector<std::string> remarks;
  if (!use.mask.empty()) remarks.push_back(mask_remark(use));
  if (!use.is_told) {
    remarks.emplace_back(
        "nearly the whole picture stays in place in most of the pictures, as that of a vehicle at "
        "rest does; whether a part of the vehicle or text is in view cannot be told");
  }
  const auto first = std::ranges::find(use.repeats, true);
  if (first != use.repeats.end()) {
    const auto count = static_cast<std::size_t>(std::ranges::count(use.repeats, true));
    const auto frame = static_cast<std::size_t>(first - use.repeats.begin());
    remarks.push_back(fmt::format(
        "{} {} the one before {} (first: {}), no motion was measured there: the camera hung, or "
        "files were copied",
        counted(count, "picture"), count > 1 ? "repeat" : "repeats", count > 1 ? "them" : "it",
        in_quotes(frames.picture_name(frame))));
  }
  return remarks;
}

}  // namespace fathom
