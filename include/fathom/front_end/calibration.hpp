#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fathom/datasets/absolute_readings.hpp"
#include "fathom/datasets/frame_source.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/geometry/trajectory.hpp"

namespace fathom {

/// A registration of two near frames as calibration needs it: whatever the mounting is taken for.
struct SeenMotion {
  std::size_t from = 0;  ///< frames
  std::size_t to = 0;
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;
  Pose camera;  ///< of the camera at `to` in that at `from`: x to the top of the picture, y left
  double variance_m2 = 0.0;  ///< of its x and y together, as the registration tells it
  double variance_rad2 = 0.0;
  /// The same of dead reckoning's motion meanwhile, as it tells them; 0: it does not.
  double reckoned_variance_m2 = 0.0;
  double reckoned_variance_rad2 = 0.0;
};

/// Of a registration, a motion of the body with the camera mounted as its model says.
SeenMotion seen_motion(const FrameSource& frames, std::size_t from, std::size_t to,
                       const UncertainPose& registered);

/// What calibration looks at.
struct CalibrationInput {
  std::vector<SeenMotion> motions;  ///< of near frames, by rising `to`
  RecordedOdometry odometry;        ///< what they are held against
  bool is_visual_odometry = false;  ///< it is made of the same registrations, and tells nothing
  std::vector<std::int64_t> frame_times_ns;
  std::vector<double> altitudes_m;  ///< of the frames
  CameraModel camera;
  SetUpFiles files;                     ///< where what is found is to be written
  AbsoluteReadings readings;            ///< headings and fixes as a run has them
  std::vector<StampedPose> references;  ///< ground truth, where there is some
};

/// All but the motions. Of frames with dead reckoning.
CalibrationInput calibration_input(const FrameSource& frames, const AbsoluteReadings& readings);

/// With its standard deviation.
struct Estimated {
  double value = 0.0;
  double sigma = 0.0;

  /// Further from `expected` than `sigmas` standard deviations, and than `least`.
  bool is_off(double expected, double sigmas, double least) const;
};

/// Pictures from `first` to `last` that belong so many places later.
struct MovedPictures {
  std::size_t first = 0;
  std::size_t last = 0;
  std::ptrdiff_t places = 0;
};

/// What registered motions say against dead reckoning (docs/calibration.md).
struct SetUp {
  std::size_t motions = 0;           ///< registrations that dead reckoning covers
  OdometryFormat format;             ///< of dead reckoning that fits pictures taken as they are
  bool is_reversed = false;          ///< pictures are counted from the end
  bool is_mirrored = false;          ///< and of mirrored pictures, which no format stands for
  std::vector<MovedPictures> moved;  ///< by rising number; all else is of them where they belong
  bool is_related = true;            ///< whether the two have anything to do with each other
  Estimated scale;                   ///< registered motions over those of dead reckoning
  Estimated least_scale;             ///< the same, were all that is left of registrations' errors
  Estimated yaw_rad;                 ///< of the camera's mounting
  Estimated lever_x_m;
  Estimated lever_y_m;
  Estimated time_offset_s;    ///< to be added to the time stamps of dead reckoning
  bool is_clock_told = true;  ///< false: altitudes that contradict one another look like a clock
  double sigma_m = 0.0;       ///< of what is left, a motion
  double sigma_rad = 0.0;
  /// Where the scale changes, once: the time, and by which factor it grows.
  struct Step {
    std::int64_t time_ns = 0;
    Estimated factor;
    double altitude_factor = 1.0;  ///< of the altitudes there
  };
  std::optional<Step> step;
};

/// How headings, fixes or ground truth turn where dead reckoning turns: 1, or −1 where they turn
/// the other way.
struct TurnComparison {
  std::string source;  ///< "compass0", "position0", "ground truth"
  Estimated slope;
  std::optional<Estimated> time_offset_s;  ///< of a compass: to be added to its time stamps
};

/// Where a source says that the vehicle goes, against where dead reckoning says, seen from the
/// vehicle: 0, or the angle between their axes.
struct DirectionComparison {
  std::string source;  ///< "ground truth", or "position0" with the headings of compass0
  Estimated turned_rad;
};

/// Everything that can be told of a survey's set-up. Lines have no final full stop.
struct Calibration {
  std::optional<SetUp> set_up;  ///< without dead reckoning of its own: nothing
  std::vector<TurnComparison> turns;
  std::vector<DirectionComparison> directions;
  std::vector<std::string> findings;  ///< what is wrong, with its number and the line to write
  std::vector<std::string> untold;    ///< what the survey cannot tell
};

/// Needs some eight motions to say anything of the set-up.
Calibration calibrate(const CalibrationInput& input);

/// What was measured, a line each.
std::vector<std::string> facts_of(const Calibration& calibration);

}  // namespace fathom
