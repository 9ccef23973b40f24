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

std::string format_remedy(const CalibrationInput& input, const OdometryFormat& format) {
  return in_file(input, "convention: " + name_of(format.convention), "odometry0");
}

// What the poses of a convention are like.
std::string described(OdometryConvention convention) {
  switch (convention) {
    case OdometryConvention::counter_clockwise_from_x:
      return "y to port and heading counter-clockwise";
    case OdometryConvention::north_east_down:
      return "y to starboard and heading clockwise, as north, east, down";
    case OdometryConvention::clockwise_from_x:
      return "y to port and heading clockwise";
    case OdometryConvention::clockwise_from_y:
      return "x to the east, y to the north and heading clockwise from north";
    case OdometryConvention::y_to_starboard:
      break;
  }
  return "y to starboard and heading counter-clockwise";
}

// A source that turns opposite to what the pictures show.
bool is_opposite_to_pictures(const TurnComparison& turn, const Calibration& calibration) {
  const bool is_of_mirrored = calibration.set_up && calibration.set_up->is_mirrored;
  return (turn.slope.value < 0.0) != is_of_mirrored;
}

}  // namespace

Senses senses_of(const CalibrationInput& input, const Calibration& calibration) {
  Senses senses;
  int agree = 0;
  int opposite = 0;
  if (calibration.set_up && !input.is_visual_odometry) {
    senses.odometry_is_opposite = calibration.set_up->is_mirrored ||
                                  is_mirror_of(calibration.set_up->format, input.odometry.format);
    ++(senses.odometry_is_opposite ? opposite : agree);
    if (senses.odometry_is_opposite) senses.by.emplace_back("odometry0");
  }
  for (const TurnComparison& turn : calibration.turns) {
    const bool is_opposite = is_opposite_to_pictures(turn, calibration);
    if (turn.source == "ground truth") {
      senses.pictures_are_mirrored = is_opposite;
      senses.by = {turn.source};
      return senses;
    }
    if (turn.source == kTruthPath) continue;
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
            input,
            std::string("heading_unit: ") + (found.format.is_in_degrees ? "degrees" : "radians"),
            "odometry0")));
  }
  const bool is_another = found.format.convention != configured.convention;
  if (found.is_mirrored && senses.is_told && !senses.pictures_are_mirrored) {
    findings.push_back(
        fmt::format("headings of odometry0 count the other way than {} says: {} fit mirrored "
                    "pictures, which these are not; correct them, or name their convention",
                    name_of(configured.convention), of));
  }
  if (found.is_mirrored && !senses.is_told) {
    findings.push_back(fmt::format(
        "pictures and odometry0 turn opposite ways: {} fit it once they are mirrored. Either "
        "pictures are {} ({}), or headings of odometry0 count the other way; a compass, fixes or "
        "ground truth would tell",
        of, input.camera.is_mirrored ? "not mirrored" : "mirrored", mirror_remedy(input)));
  }
  if (!is_another) return;
  const std::string senses_of_odometry = format_remedy(input, found.format);
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
        "Either pictures are {} ({}), or odometry0 has {} (write {}); a compass, fixes or ground "
        "truth would tell",
        of, input.camera.is_mirrored ? "not mirrored" : "mirrored", mirror_remedy(input),
        described(found.format.convention), senses_of_odometry));
  } else if (!senses.pictures_are_mirrored) {
    findings.push_back(fmt::format("odometry0 has {}{}: {} fit it then; write {}",
                                   described(found.format.convention), told, of,
                                   senses_of_odometry));
  }
}

bool find_directions(const Calibration& calibration, std::vector<std::string>& findings) {
  constexpr double kLeast_rad = 0.3;
  bool axes_are_turned = false;
  for (const DirectionComparison& one : calibration.directions) {
    if (!one.turned_rad.is_off(0.0, kFindingSigmas, kLeast_rad)) continue;
    const bool is_of_truth = one.source == "ground truth";
    // Told of already, by the better source.
    if (axes_are_turned && !is_of_truth) continue;
    axes_are_turned = axes_are_turned || is_of_truth;
    findings.push_back(
        is_of_truth
            ? fmt::format("seen from the vehicle, ground truth goes {} rad from where odometry0 "
                          "says: x and y of odometry0 are exchanged, or one has the other sign, or "
                          "the axes of one of the two are not the vehicle's",
                          with_sigma(one.turned_rad))
            : fmt::format(
                  "position0 goes {} rad from where compass0 and odometry0 say: they have "
                  "different axes. Headings from north (convention: clockwise_from_north) "
                  "need fixes with x to the north and y to the west, or in latitude and "
                  "longitude, or dataset.origin, whose heading says where x points; or x and "
                  "y of odometry0 are exchanged",
                  with_sigma(one.turned_rad)));
  }
  return axes_are_turned;
}

namespace {

void find_mirrored_truth(const Calibration& calibration, const TurnComparison& path,
                         std::vector<std::string>& findings) {
  const TurnComparison& headings = calibration.turns.front();
  if (path.slope.value * headings.slope.value > 0.0) return;
  findings.push_back(fmt::format(
      "ground truth contradicts itself: its path turns {} where dead reckoning turns 1, "
      "its headings turn {}: x and y of its positions are swapped, one has the other "
      "sign, or its headings count the other way",
      with_sigma(path.slope), with_sigma(headings.slope)));
}

}  // namespace

void find_turns(const CalibrationInput& input, const Calibration& calibration, const Senses& senses,
                std::vector<std::string>& findings) {
  constexpr double kLeastOfCompass_s = 0.25;
  for (const TurnComparison& turn : calibration.turns) {
    if (turn.source == "ground truth") continue;
    if (turn.source == kTruthPath) {
      find_mirrored_truth(calibration, turn, findings);
      continue;
    }
    const bool is_opposite =
        is_opposite_to_pictures(turn, calibration) != senses.pictures_are_mirrored;
    const bool is_compass = turn.source == "compass0";
    if (is_opposite && senses.is_told) {
      findings.push_back(fmt::format(
          "{} where the vehicle turns {}",
          is_compass ? "compass0 counts the other way: it says " + with_sigma(turn.slope)
                     : "position0 is mirrored: its path turns " + with_sigma(turn.slope),
          is_compass
              ? "1; write " + in_file(input, "convention: clockwise_from_north", "compass0") +
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
