#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>

#include "fathom/vision/camera.hpp"

namespace fathom {

/// The files of the EuRoC/ASL folder layout, one by one (docs/formats.md).

/// Reads the `sensor.yaml` of a camera: `resolution`, `intrinsics` [fx, fy, cx, cy],
/// `distortion_model` (none, or a name of distortion_models()), `distortion_coefficients` and
/// `mounting` {x, y, yaw}; m and rad; `mirrored`. Other keys are not looked at, so files of EuRoC
/// itself are read. Throws InputError with file and line.
Camera read_camera_yaml(const std::filesystem::path& path);

/// The same, as text.
std::string camera_yaml(const CameraModel& model);

/// A line of a sensor's `data.csv`: numbers with 17 digits.
std::string sensor_row(std::int64_t time_ns, std::initializer_list<double> values);

/// Writes `folder`/data.csv, the columns in a comment before its rows, and `folder`/sensor.yaml;
/// makes the folder. Throws InputError.
void write_sensor(const std::filesystem::path& folder, const std::string& columns,
                  const std::string& rows, const std::string& yaml);

/// The latest time stamp, and the negative of the earliest: in 2112. Any two, with the offset of a
/// clock, are less apart than 64 bits can tell.
inline constexpr std::int64_t kMostTimeNs = 4'500'000'000'000'000'000;

/// Bounds of what `attitude0` may say: no survey of a floor flies more tilted, but degrees taken
/// for radians are beyond.
inline constexpr double kMostTiltRad = 1.0;
inline constexpr double kMostTiltSigmaRad = 0.5;

/// The same for the sensors whose columns are known: each takes its rows.
void write_camera(const std::filesystem::path& mav0, const std::string& rows,
                  const CameraModel& model);
void write_altimeter(const std::filesystem::path& mav0, const std::string& rows);
void write_attitude(const std::filesystem::path& mav0, const std::string& rows);
/// Columns timestamp, heading, sigma: of the body, counter-clockwise from the world's x axis.
void write_compass(const std::filesystem::path& mav0, const std::string& rows);
void write_odometry(const std::filesystem::path& mav0, const std::string& rows);
/// `folder`: state_groundtruth_estimate0, by its path.
void write_reference(const std::filesystem::path& folder, const std::string& rows);

}  // namespace fathom
