#include "fathom/datasets/folder_sensors.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <system_error>

#include <Eigen/LU>

#include "fathom/core/csv.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/asl_files.hpp"
#include "sensor_csv.hpp"
#include "sensor_yaml.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWorldColumns =
    "timestamp [ns],x [m],y [m],var_x [m^2],cov_xy [m^2],var_y [m^2]";
constexpr const char* kEarthColumns =
    "timestamp [ns],latitude [deg],longitude [deg],var_north [m^2],cov_north_east [m^2],var_east "
    "[m^2]";

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

std::string text_of(const TimeSpan& span) {
  return fmt::format("{} to {} ns", span.first_ns, span.last_ns);
}

// Takes what is behind the #, of each line that begins with one, as far as a row may reach.
template <class Take>
void for_comments(const fs::path& path, const Take& take) {
  const std::string content = read_text(path);
  for (const auto& [line, text] : lines_of(content)) {
    if (text.starts_with('#')) take(TextLine{line, text.substr(1, kLongestRow)});
  }
}

// Older imports wrote the square.
void refuse_variances(const fs::path& csv) {
  for_comments(csv, [&](const TextLine& comment) {
    if (comment.text.find("variance") == comment.text.npos) return;
    throw InputError(csv.string(), comment.number,
                     "the third column is a variance; expected timestamp, heading [rad], sigma "
                     "[rad]: import the bag again, or write square roots");
  });
}

MeasuredHeading heading_of(const SensorCsv& csv, const SensorRow& row) {
  const MeasuredHeading reading{row.time_ns, csv.real(row, 1), csv.real(row, 2)};
  if (std::abs(reading.heading_rad) > 2.0 * std::numbers::pi) {
    csv.refuse(row,
               "heading " + row.fields[1] + " is beyond 2 pi; is it in degrees? expected radians");
  }
  if (!(reading.sigma_rad > 0.0 && reading.sigma_rad <= std::numbers::pi)) {
    csv.refuse(row, "sigma " + row.fields[2] +
                        " is no standard deviation of a heading; expected radians > 0, at most pi");
  }
  return reading;
}

FolderCompass read_compass(const fs::path& folder, const TimeSpan& survey) {
  const fs::path path = folder / "data.csv";
  const SensorYaml yaml = read_sensor_yaml(folder / "sensor.yaml");
  refuse_variances(path);
  const SensorCsv csv(path, "timestamp, heading, sigma", "", yaml.time_offset_ns);
  FolderCompass compass{{}, yaml.is_from_north, yaml.mount_yaw_rad, 0, {}, yaml.keeps_outliers};
  for (const SensorRow& row : csv.rows()) {
    const MeasuredHeading reading = heading_of(csv, row);
    if (survey.holds(row.time_ns)) {
      compass.readings.push_back(reading);
      compass.lines.push_back(row.line);
    } else {
      ++compass.left_out;
    }
  }
  if (compass.readings.empty()) {
    throw InputError(path.string(), "none of " + std::to_string(compass.left_out) +
                                        " headings is at the time of the pictures, " +
                                        text_of(survey) + "; do both have the same clock?");
  }
  return compass;
}

// Whether the file's columns are those on Earth.
bool is_on_earth(const fs::path& csv) {
  std::optional<bool> on_earth;
  for_comments(csv, [&](const TextLine& comment) {
    const std::vector<std::string> names = names_of_columns(comment.text);
    if (names.size() < 3) return;
    const auto has = [&names](const char* name) {
      return std::ranges::find(names, name) != names.end();
    };
    const bool world = has("x") || has("y");
    const bool earth = has("latitude") || has("longitude");
    if (!world && !earth) return;
    if ((world && earth) || (on_earth && *on_earth != earth)) {
      throw InputError(csv.string(), comment.number,
                       "fixes in two frames, x, y and latitude, longitude; expected one of them");
    }
    const bool is_in_order = earth ? names[1] == "latitude" && names[2] == "longitude"
                                   : names[1] == "x" && names[2] == "y";
    if (!is_in_order) {
      throw InputError(
          csv.string(), comment.number,
          std::string("expected the columns ") + (earth ? kEarthColumns : kWorldColumns));
    }
    on_earth = earth;
  });
  if (on_earth) return *on_earth;
  throw InputError(csv.string(),
                   fmt::format("does not name its columns; expected a first line #{}, or #{}",
                               kWorldColumns, kEarthColumns));
}

Eigen::Matrix2d covariance_of(const SensorCsv& csv, const SensorRow& row) {
  // Before the initialiser: with assertions, Eigen ends the program where one is left half-way.
  const double var_x = csv.real(row, 3);
  const double cov_xy = csv.real(row, 4);
  const double var_y = csv.real(row, 5);
  Eigen::Matrix2d C;
  C << var_x, cov_xy, cov_xy, var_y;
  if (C(0, 0) > 0.0 && C(1, 1) > 0.0 && C.determinant() > 0.0) return C;
  csv.refuse(row,
             "the covariance of the fix is not positive definite; expected variances > 0 and a "
             "correlation between -1 and 1");
}

EarthFix earth_fix(const SensorCsv& csv, const SensorRow& row) {
  const EarthFix fix{row.time_ns, csv.real(row, 1), csv.real(row, 2), covariance_of(csv, row),
                     row.line};
  if (std::abs(fix.latitude_deg) > 90.0 || std::abs(fix.longitude_deg) > 180.0) {
    csv.refuse(row, "latitude " + row.fields[1] + " and longitude " + row.fields[2] +
                        " are not on Earth; expected degrees, at most 90 and 180");
  }
  return fix;
}

FolderFixes read_fixes(const fs::path& folder, const TimeSpan& survey, const TimeSpan& recorded) {
  FolderFixes fixes;
  fixes.csv = folder / "data.csv";
  const SensorYaml yaml = read_sensor_yaml(folder / "sensor.yaml");
  fixes.lever_m = {yaml.mount_x_m, yaml.mount_y_m};
  fixes.keeps_outliers = yaml.keeps_outliers;
  const bool on_earth = is_on_earth(fixes.csv);
  const SensorCsv csv(fixes.csv,
                      on_earth ? "timestamp, latitude, longitude, var_north, "
                                 "cov_north_east, var_east"
                               : "timestamp, x, y, var_x, cov_xy, var_y",
                      "", yaml.time_offset_ns);
  for (const SensorRow& row : csv.rows()) {
    if (!survey.holds(row.time_ns)) {
      if (recorded.holds(row.time_ns)) continue;
      csv.refuse(row, fmt::format("a fix at {} ns is outside the time of the pictures, {}; remove "
                                  "its row, or see whether both have the same clock",
                                  row.time_ns, text_of(recorded)));
    }
    fixes.lines.push_back(row.line);
    if (on_earth) {
      fixes.on_earth.push_back(earth_fix(csv, row));
    } else {
      fixes.in_world.push_back(
          {row.time_ns, {csv.real(row, 1), csv.real(row, 2)}, covariance_of(csv, row)});
    }
  }
  return fixes;
}

}  // namespace

FolderSensors read_folder_sensors(const fs::path& mav0, const TimeSpan& survey,
                                  const TimeSpan& recorded) {
  FolderSensors sensors;
  if (is_there(mav0 / "compass0")) sensors.compass = read_compass(mav0 / "compass0", survey);
  if (is_there(mav0 / "position0"))
    sensors.fixes = read_fixes(mav0 / "position0", survey, recorded);
  if (is_there(mav0 / "position1")) {
    throw InputError((mav0 / "position1").string(),
                     "is a second positioning system; expected position0 alone, in one frame");
  }
  return sensors;
}

void write_folder_sensors(const AbsoluteReadings& readings, const fs::path& mav0) {
  if (!readings.headings.empty()) {
    std::string rows;
    for (const MeasuredHeading& reading : readings.headings) {
      rows += sensor_row(reading.time_ns, {reading.heading_rad, reading.sigma_rad});
    }
    write_compass(mav0, rows);
  }
  if (readings.fixes.empty()) return;
  std::string rows;
  for (const PositionFix& fix : readings.fixes) {
    rows += sensor_row(fix.time_ns, {fix.position_m.x(), fix.position_m.y(), fix.covariance(0, 0),
                                     fix.covariance(0, 1), fix.covariance(1, 1)});
  }
  write_sensor(mav0 / "position0", kWorldColumns, rows,
               "sensor_type: position\nmounting: {x: " + exact(readings.lever_m.x()) + ", y: " +
                   exact(readings.lever_m.y()) + "} # of the antenna in the body frame; m\n" +
                   (readings.has_jumps ? "outliers: keep\n" : ""));
}

}  // namespace fathom
