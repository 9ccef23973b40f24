#include "fathom/front_end/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "fathom/core/text.hpp"
#include "fathom/datasets/camera_doubts.hpp"
#include "fathom/datasets/series_outliers.hpp"
#include "findings.hpp"
#include "set_up.hpp"

namespace fathom {
namespace {

void find_untold(const SetUp& found, const Senses& senses, std::vector<std::string>& untold) {
  constexpr double kWideLever_m = 0.3;
  constexpr double kWideScale = 0.1;
  constexpr double kWideClock_s = 1.0;
  const double lever_m = std::max(found.lever_x_m.sigma, found.lever_y_m.sigma);
  if (lever_m > kWideLever_m) {
    untold.push_back(
        fmt::format("where the camera is mounted: the vehicle turns too little (σ {} m)",
                    short_number(lever_m, 2)));
  }
  if (found.scale.sigma > kWideScale * found.scale.value) {
    untold.push_back(
        fmt::format("the scale: registrations are too uncertain for motions so short (σ {})",
                    short_number(found.scale.sigma, 2)));
  } else if (errors_make_scale(found)) {
    untold.push_back(
        fmt::format("the scale: errors of registrations (of tilt, of altitudes) that their "
                    "covariances do not tell may make it {}, and it may be {}",
                    short_number(found.scale.value, 3), short_number(found.least_scale.value, 3)));
  }
  if (!found.is_clock_told) {
    untold.emplace_back("dead reckoning's clock: altitudes contradict one another");
  } else if (found.time_offset_s.sigma > kWideClock_s) {
    untold.push_back(fmt::format("dead reckoning's clock: the motion is too even (σ {} s)",
                                 short_number(found.time_offset_s.sigma, 2)));
  }
  if (!senses.is_told) untold.emplace_back("whether pictures or odometry0 are mirrored");
  untold.emplace_back(
      "the scale of dead reckoning itself, nor a yaw that its sensor and the camera share");
}

std::string unrelated_text(const SetUp& found) {
  return fmt::format(
      "{} registered motions have nothing to do with those of odometry0, in no order, sense, scale "
      "or mounting: are they of the same survey, with clocks at most 5 s apart?",
      found.motions);
}

bool are_altitudes_plausible(const CalibrationInput& input) {
  const auto plausible = plausible_altitudes(input.frame_times_ns, input.altitudes_m);
  return std::ranges::count(plausible, false) == 0;
}

}  // namespace

Calibration calibrate(const CalibrationInput& input) {
  Calibration calibration;
  // camera_doubts tells of it.
  if (principal_point_looks_exchanged(input.camera)) return calibration;
  find_times(input.frame_times_ns, calibration.findings);
  find_size(input.camera, calibration.findings);
  // All else would be off for these.
  if (!calibration.findings.empty()) return calibration;
  if (find_still_odometry(input, calibration.findings)) return calibration;
  if (!input.is_visual_odometry) calibration.set_up = find_set_up(input);
  std::optional<SetUp>& found = calibration.set_up;
  if (found) found->is_clock_told = are_altitudes_plausible(input);
  if (found && !found->is_related) {
    calibration.findings.push_back(unrelated_text(*found));
    return calibration;
  }
  if (input.odometry.rows.size() > 1) {
    const double offset_s = found && is_late(*found) ? found->time_offset_s.value : 0.0;
    const OdometryTrack track(input.odometry, found ? found->format : input.odometry.format,
                              offset_s);
    calibration.turns = compare_turns(input, track);
    calibration.directions = compare_directions(input, track, calibration.turns);
    find_still_headings(input, track, calibration.findings);
    find_lengths(input, track, found ? found->scale.value : 1.0, calibration.findings);
  }
  const Senses senses = senses_of(input, calibration);
  if (senses.pictures_are_mirrored) {
    calibration.findings.push_back(
        fmt::format("the pictures are {}: what they show turns the other way than {}; {}",
                    input.camera.is_mirrored ? "not mirrored, as is configured" : "mirrored",
                    joined(senses.by, " and "), mirror_remedy(input)));
  }
  const bool axes_are_turned = find_directions(calibration, calibration.findings);
  if (found) {
    if (found->is_reversed) {
      calibration.findings.push_back(fmt::format(
          "the pictures are in reverse order: {} registered motions fit dead reckoning counted "
          "from the end; turn the file names of cam0/data.csv round",
          found->motions));
    }
    find_order(input, *found, calibration.findings);
    // Axes of odometry that are turned look like another convention and mounting.
    if (!axes_are_turned || found->format.convention == input.odometry.format.convention) {
      find_format(input, *found, senses, calibration.findings);
      find_mounting(input, *found, senses.pictures_are_mirrored, calibration.findings);
    }
    if (found->step) {
      find_step(input, *found, calibration.findings);
    } else {
      find_scale(input, *found, calibration.findings);
    }
    find_clock(input, *found, calibration.findings);
    // All else would be in what is left, too.
    if (calibration.findings.empty()) find_variances(input, *found, calibration.findings);
    find_untold(*found, senses, calibration.untold);
  }
  find_turns(input, calibration, senses, calibration.findings);
  return calibration;
}

std::vector<std::string> facts_of(const Calibration& calibration) {
  std::vector<std::string> facts;
  if (const auto& found = calibration.set_up; found && found->is_related) {
    facts.push_back(
        fmt::format("scale: registered motions are {} times as long as dead reckoning's",
                    with_sigma(found->scale)));
    facts.push_back(fmt::format("mounting: yaw {} rad, x {} m, y {} m", with_sigma(found->yaw_rad),
                                with_sigma(found->lever_x_m), with_sigma(found->lever_y_m)));
    if (found->is_clock_told) {
      facts.push_back(fmt::format("clock: {} s to add to dead reckoning's time stamps",
                                  with_sigma(found->time_offset_s)));
    }
    facts.push_back(fmt::format("left over: {} m and {} rad a motion, of {} motions",
                                short_number(found->sigma_m, 2), short_number(found->sigma_rad, 2),
                                found->motions));
  }
  for (const TurnComparison& turn : calibration.turns) {
    facts.push_back(fmt::format(
        "{}: turns {} where dead reckoning turns 1{}", turn.source, with_sigma(turn.slope),
        turn.time_offset_s
            ? fmt::format(", {} s to add to its time stamps", with_sigma(*turn.time_offset_s, 2))
            : ""));
  }
  for (const DirectionComparison& one : calibration.directions) {
    facts.push_back(fmt::format("{}: goes {} rad from where dead reckoning says{}", one.source,
                                with_sigma(one.turned_rad),
                                one.source == "position0" ? ", by the headings of compass0" : ""));
  }
  return facts;
}

}  // namespace fathom
