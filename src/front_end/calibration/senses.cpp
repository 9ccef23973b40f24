#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "fathom/core/text.hpp"
#include "findings.hpp"
#include "set_up.hpp"

namespace fathom {
namespace {

bool is_mirror_of(const OdometryFormat& found, const OdometryFormat& configured) {
  return found.convention != configured.convention &&
         found.convention == mirrored(configured.convention);
}

std::string format_remedy(const OdometryFormat& format) {
  return in_file("convention: " + name_of(format.convention), "odometry0");
}

}  // namespace

Senses senses_of(const CalibrationInput& input, const Calibration& calibration) {
  Senses senses;
  int agree = 0;
  int opposite = 0;
  if (calibration.set_up && !input.is_visual_odometry) {
    senses.odometry_is_opposite = is_mirror_of(calibration.set_up->format, input.odometry.format);
    ++(senses.odometry_is_opposite ? opposite : agree);
    if (senses.odometry_is_opposite) senses.by.emplace_back("odometry0");
  }
  for (const TurnComparison& turn : calibration.turns) {
    const bool is_opposite = turn.slope.value < 0.0;
    if (turn.source == "ground truth") {
      senses.pictures_are_mirrored = is_opposite;
      senses.by = {turn.source};
      return senses;
    }
    ++(is_opposite ? opposite : agree);
    senses.by.push_back(turn.source);
  }
  senses.pictures_are_mirrored = opposite > agree + 1;
  senses.is_told = senses.pictures_are_mirrored || opposite < agree + 1;
  return senses;
}

void find_format(const CalibrationInput& input, const SetUp& found, const Senses& senses,
                 std::vector<std::string>& findings) {
  const OdometryFormat& configured = input.odometry.format;
  const std::string of = fmt::format("{} registered motions", found.motions);
  if (found.format.is_in_degrees != configured.is_in_degrees) {
    findings.push_back(fmt::format(
        "headings of odometry0 are in {}: {} fit them then, and not as they are read now; write {}",
        found.format.is_in_degrees ? "degrees" : "radians", of,
        in_file(
            std::string("heading_unit: ") + (found.format.is_in_degrees ? "degrees" : "radians"),
            "odometry0")));
  }
  if (found.format.convention == configured.convention) return;
  const std::string senses_of_odometry = format_remedy(found.format);
  if (!senses.odometry_is_opposite) {
    findings.push_back(
        fmt::format("odometry0 is read in another convention than it is written: {} "
                    "fit it as {}; write {}",
                    of, name_of(found.format.convention), senses_of_odometry));
    return;
  }
  std::vector<std::string> by = senses.by;
  std::erase(by, "odometry0");
  const std::string told = by.empty() ? "" : " (as " + joined(by, " and ") + " shows)";
  if (!senses.is_told) {
    findings.push_back(fmt::format(
        "pictures and odometry0 turn opposite ways: {} fit it once y and heading change sign. "
        "Either pictures are mirrored (write {}), or odometry0 has y to starboard and heading "
        "clockwise, as north, east, down (write {}); a compass, fixes or ground truth would tell",
        of, in_file("mirrored: true", "cam0"), senses_of_odometry));
  } else if (!senses.pictures_are_mirrored) {
    findings.push_back(fmt::format(
        "odometry0 has y to starboard and heading clockwise, as north, east, down{}: {} fit it "
        "then; write {}",
        told, of, senses_of_odometry));
  }
}

void find_turns(const Calibration& calibration, const Senses& senses,
                std::vector<std::string>& findings) {
  constexpr double kLeastOfCompass_s = 0.25;
  for (const TurnComparison& turn : calibration.turns) {
    if (turn.source == "ground truth") continue;
    const bool is_opposite = (turn.slope.value < 0.0) != senses.pictures_are_mirrored;
    const bool is_compass = turn.source == "compass0";
    if (is_opposite && senses.is_told) {
      findings.push_back(fmt::format(
          "{} where the vehicle turns {}",
          is_compass ? "compass0 counts the other way: it says " + with_sigma(turn.slope)
                     : "position0 is mirrored: its path turns " + with_sigma(turn.slope),
          is_compass ? "1; write " + in_file("convention: clockwise_from_north", "compass0") +
                           ", or take it out where it stands"
                     : "1: x and y are swapped, or one of them has the other sign"));
    }
    if (is_compass && turn.time_offset_s &&
        turn.time_offset_s->is_off(0.0, kFindingSigmas, kLeastOfCompass_s)) {
      findings.push_back(fmt::format(
          "compass0's time stamps are {} s {} than dead reckoning's: add {:.2f} to its "
          "time_offset_s",
          with_sigma({std::abs(turn.time_offset_s->value), turn.time_offset_s->sigma}, 2),
          turn.time_offset_s->value < 0.0 ? "later" : "earlier", turn.time_offset_s->value));
    }
  }
}

}  // namespace fathom
