#pragma once

#include <string>
#include <vector>

#include "fathom/front_end/calibration.hpp"
#include "odometry_track.hpp"

namespace fathom {

/// A finding is so many standard deviations off; how much at least beyond what any survey is by
/// right stands with each.
inline constexpr double kFindingSigmas = 4.0;

/// "1.571 ± 0.0031".
std::string with_sigma(const Estimated& one, int digits = 3);

/// "'LINE' in SENSOR/sensor.yaml"; of plain pictures what there is in its place.
std::string in_file(const CalibrationInput& input, const std::string& line, const char* sensor);

/// "write 'mirrored: true' in …", or to take it out where it stands.
std::string mirror_remedy(const CalibrationInput& input);

/// How sources turn against the pictures.
struct Senses {
  bool odometry_is_opposite = false;
  bool is_told = true;  ///< which of the two is wrong, where they are opposite
  bool pictures_are_mirrored = false;
  std::vector<std::string> by;  ///< what told it
};

/// Ground truth decides; else what most of the others say.
Senses senses_of(const CalibrationInput& input, const Calibration& calibration);

/// Each adds what is wrong. Of odometry0's format, and of mirrored pictures.
void find_format(const CalibrationInput& input, const SetUp& found, const Senses& senses,
                 std::vector<std::string>& findings);
/// Of pictures that belong elsewhere.
void find_order(const CalibrationInput& input, const SetUp& found,
                std::vector<std::string>& findings);
void find_mounting(const CalibrationInput& input, const SetUp& found, bool is_mirrored,
                   std::vector<std::string>& findings);
/// Of dead reckoning whose axes are turned against those of ground truth, or of fixes whose are
/// against those of the compass. Whether the former is.
bool find_directions(const Calibration& calibration, std::vector<std::string>& findings);
void find_step(const CalibrationInput& input, const SetUp& found,
               std::vector<std::string>& findings);
/// "; millimetres are taken for metres" where a factor has a name.
std::string named_factor(double factor);
/// Of ground truth or fixes whose ways are many times as long, or short, as those of dead reckoning
/// and of registrations, which are `registered` times those of dead reckoning.
void find_lengths(const CalibrationInput& input, const OdometryTrack& track, double registered,
                  std::vector<std::string>& findings);
bool is_scale_off(const SetUp& found);
/// Whether errors of registrations, which their covariances do not tell, would make it so.
bool errors_make_scale(const SetUp& found);
void find_scale(const CalibrationInput& input, const SetUp& found,
                std::vector<std::string>& findings);
/// Whether dead reckoning's clock is off.
bool is_late(const SetUp& found);
void find_clock(const CalibrationInput& input, const SetUp& found,
                std::vector<std::string>& findings);
/// Of dead reckoning whose variances are of another unit than what is left of its motions.
void find_variances(const CalibrationInput& input, const SetUp& found,
                    std::vector<std::string>& findings);
/// Of compass and fixes.
void find_turns(const CalibrationInput& input, const Calibration& calibration, const Senses& senses,
                std::vector<std::string>& findings);
/// Of dead reckoning without headings: whether it is that, and nothing else can be told.
bool find_still_odometry(const CalibrationInput& input, std::vector<std::string>& findings);
/// Of a compass or of ground truth whose headings are one and the same while dead reckoning turns.
void find_still_headings(const CalibrationInput& input, const OdometryTrack& track,
                         std::vector<std::string>& findings);
/// Of time stamps of pictures in another unit.
void find_times(const std::vector<std::int64_t>& times_ns, std::vector<std::string>& findings);
/// Of pictures that have another size than the calibration's.
void find_size(const CameraModel& camera, std::vector<std::string>& findings);

}  // namespace fathom
