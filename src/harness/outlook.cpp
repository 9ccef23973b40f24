#include "fathom/harness/outlook.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "fathom/core/median.hpp"
#include "fathom/core/text.hpp"
#include "fathom/vision/features.hpp"

namespace fathom {
namespace {

std::string range_text(const Spread& spread, const std::string& unit) {
  const std::string least = short_number(spread.least);
  const std::string most = short_number(spread.most);
  return (least == most ? least : least + " to " + most) + unit;
}

void measure_footprint(const FrameSource& frames, Outlook& outlook) {
  std::vector<double> altitudes_m;
  for (std::size_t i = 0; i < frames.size(); ++i) altitudes_m.push_back(frames.info(i).altitude_m);
  const auto corners = frames.camera().footprint(upper_median(std::move(altitudes_m)));
  outlook.footprint_width_m = (corners[1] - corners[0]).norm();
  outlook.footprint_height_m = (corners[2] - corners[1]).norm();
}

void count_candidates(const FrameSource& frames, const FrontEndOptions& options, Outlook& outlook) {
  RegistrationPlan plan = plan_registrations(frames, options);
  outlook.keyframes = plan.candidates.size();
  outlook.consecutive_candidates = plan.consecutive;
  outlook.widest = plan.widest;
  outlook.other_candidates = plan.all_candidates() - plan.consecutive;
  if (outlook.keyframes > 1) {
    outlook.in_metres = in_metres(options, frames.camera(), std::move(plan.lengths));
  }
}

void look_at_texture(const FrameSource& frames, const FrontEndOptions& options, Outlook& outlook) {
  constexpr std::size_t kLooked = 5;
  const FeatureExtractor extractor(options.features, options.registration.tuning.features);
  const PictureUse use = picture_use(frames, options.mask);
  outlook.remarks = remarks_on(use, frames);
  const std::size_t count = std::min(kLooked, frames.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t frame = (2 * i + 1) * frames.size() / (2 * count);
    outlook.features.emplace_back(frame, extractor.extract(frames.image(frame), use.mask).size());
  }
}

}  // namespace

Outlook outlook(const FrameSource& frames, const FrontEndOptions& options) {
  Outlook outlook;
  if (frames.size() == 0) return outlook;
  measure_footprint(frames, outlook);
  if (frames.has_odometry()) count_candidates(frames, options, outlook);
  look_at_texture(frames, options, outlook);
  return outlook;
}

std::vector<std::string> facts_of(const Outlook& outlook) {
  std::vector<std::string> facts{fmt::format("footprint: {} m x {} m from the median altitude",
                                             short_number(outlook.footprint_width_m),
                                             short_number(outlook.footprint_height_m))};
  if (const auto& metres = outlook.in_metres) {
    facts.push_back(fmt::format("keyframes: {}, {} apart, median {} m", outlook.keyframes,
                                range_text(metres->step_m, " m"),
                                short_number(metres->step_m.median)));
    facts.push_back(fmt::format(
        "candidates by dead reckoning: {} of consecutive keyframes, {} others, within {}",
        outlook.consecutive_candidates, outlook.other_candidates,
        range_text(metres->reach_m, " m")));
    facts.push_back("a match agrees within " + range_text(metres->max_error_m, " m"));
  }
  if (!outlook.features.empty()) {
    std::string text = "features in pictures";
    for (const auto& [frame, count] : outlook.features) {
      text +=
          (text.back() == 's' ? " " : ", ") + std::to_string(frame) + ": " + std::to_string(count);
    }
    facts.push_back(text);
  }
  return facts;
}

std::vector<std::string> warnings_of(const Outlook& outlook, const FrontEndOptions& options) {
  std::vector<std::string> warnings = outlook.remarks;
  if (outlook.keyframes == 1) {
    warnings.emplace_back("by dead reckoning the vehicle never moves: there is a single keyframe");
  }
  if (outlook.in_metres && outlook.other_candidates == 0) {
    warnings.emplace_back(
        "by dead reckoning no picture overlaps an earlier one but the one before it: nothing to "
        "close a loop with");
  }
  constexpr std::size_t kFew = 10;
  const auto few = kFew * static_cast<std::size_t>(options.registration.ransac.min_inliers);
  for (const auto& [frame, count] : outlook.features) {
    if (count >= few) continue;
    warnings.push_back(
        fmt::format("picture {} has {} features; a registration needs {} of them to agree: too "
                    "little texture, too dark or blurred",
                    frame, count, options.registration.ransac.min_inliers));
  }
  return warnings;
}

}  // namespace fathom
