#include "trajectory_lines.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

using Fields = std::vector<std::string_view>;

double real(const LineOfFile& line, std::string_view field) {
  const auto number = parse_real(field);
  if (number) return *number;
  const bool has_comma = field.find(',') != std::string_view::npos;
  line.refuse(in_quotes(field) + " is not a finite number" +
              (has_comma ? ": decimal commas? expected points" : ""));
}

// A double holds a Unix time only to some 100 ns, the 64 bits of a long double hold it to the
// nanosecond. The text is that of a number.
long double long_real(std::string_view text) {
  if (text.front() == '+') text.remove_prefix(1);
  long double value = 0.0L;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// Whole nanoseconds, also as 1.7e+18 or with zeros behind a point.
std::int64_t nanoseconds(const LineOfFile& line, std::string_view text) {
  if (const auto whole = parse_integer(text)) return *whole;
  constexpr double kBeyond = 9.2e18;
  const auto number = parse_real(text);
  if (number && std::abs(*number) < kBeyond) {
    const long double exact = long_real(text);
    if (exact == std::floor(exact)) return static_cast<std::int64_t>(exact);
  }
  line.refuse("the time stamp " + in_quotes(text) + " is not in whole nanoseconds" +
              (number ? "; --from tum reads commas, seconds and qx, qy, qz, qw" : ""));
}

template <std::size_t N>
std::array<double, N> reals(const LineOfFile& line, const Fields& fields) {
  std::array<double, N> values{};
  for (std::size_t i = 0; i < N; ++i) values[i] = real(line, fields[i]);
  return values;
}

Eigen::Quaterniond quaternion(const LineOfFile& line, double w, double x, double y, double z,
                              const std::string& order) {
  const double norm_squared = w * w + x * x + y * y + z * z;
  // Few digits are no fault; what is far from 1 is no quaternion, or another column.
  if (!(norm_squared > 0.5 && norm_squared < 2.0)) {
    line.refuse(fmt::format("{} must have length 1, not {:f}", order, std::sqrt(norm_squared)));
  }
  return {w, x, y, z};
}

// The rotation nearest to a matrix of few digits (Frobenius norm).
Eigen::Quaterniond nearest_rotation(const LineOfFile& line, const Eigen::Matrix3d& matrix) {
  constexpr double kFewDigits = 0.01;
  const Eigen::Matrix3d excess = matrix * matrix.transpose() - Eigen::Matrix3d::Identity();
  if (!(excess.cwiseAbs().maxCoeff() <= kFewDigits)) {
    line.refuse(
        "columns 1 to 3, 5 to 7 and 9 to 11 must be a rotation matrix; its rows are not of length "
        "1 and at right angles");
  }
  if (matrix.determinant() < 0.0) {
    line.refuse(
        "columns 1 to 3, 5 to 7 and 9 to 11 must be a rotation matrix, not a reflection "
        "(determinant -1)");
  }
  // One of all digits is left as it is.
  constexpr double kRounding = 1e-14;
  if (excess.cwiseAbs().maxCoeff() < kRounding) return Eigen::Quaterniond(matrix).normalized();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  return Eigen::Quaterniond(rotation).normalized();
}

}  // namespace

void LineOfFile::refuse(const std::string& what) const {
  throw InputError(*name_, number_, what);
}

std::vector<LineOfFile> trajectory_lines(std::string_view content, const std::string& name) {
  std::vector<LineOfFile> lines;
  for (const auto& [number, whole] : lines_of(content)) {
    const std::string_view text = trim(whole.substr(0, whole.find('#')));
    if (text.empty()) continue;
    lines.emplace_back(name, number, text);
    if (text.size() > kLongestRow) lines.back().refuse(kTooLongRow);
  }
  return lines;
}

bool has_commas(const LineOfFile& line) {
  constexpr std::size_t kFewest = 8;
  if (line.text().find(',') == std::string_view::npos) return false;
  const Fields words = split(line.text(), " \t;");
  const bool is_inside = std::none_of(words.begin(), words.end(), [](std::string_view word) {
    return word.front() == ',' || word.back() == ',';
  });
  const Fields fields = split_csv(line.text());
  // Numbers that are all parted by commas, each of them cut in two.
  const bool are_halves = fields.size() == 2 * kFewest &&
                          std::all_of(fields.begin(), fields.end(), [](std::string_view field) {
                            return parse_integer(field).has_value();
                          });
  if ((words.size() >= kFewest && is_inside) || are_halves) {
    line.refuse("decimal commas? expected points: " + in_quotes(line.text()));
  }
  return true;
}

std::int64_t time_of(const LineOfFile& line, std::string_view seconds) {
  const double approximate = real(line, seconds);
  if (std::abs(approximate) > 9e9) {
    line.refuse(fmt::format("the time stamp {} is not in seconds{}", in_quotes(seconds),
                            approximate > 9e16 ? " but, it seems, nanoseconds" : ""));
  }
  return static_cast<std::int64_t>(std::llround(long_real(seconds) * 1e9L));
}

StampedSpatialPose tum_pose(const LineOfFile& line, bool has_commas) {
  const Fields fields = has_commas ? split_csv(line.text()) : split(line.text());
  if (fields.size() != 8) {
    line.refuse("expected 't x y z qx qy qz qw', got " + counted(fields.size(), "field"));
  }
  const auto v = reals<8>(line, fields);
  return {time_of(line, fields[0]),
          {{v[1], v[2], v[3]}, quaternion(line, v[7], v[4], v[5], v[6], "qx qy qz qw")}};
}

StampedSpatialPose euroc_pose(const LineOfFile& line) {
  Fields fields = split_csv(line.text());
  if (fields.size() < 8) {
    line.refuse("expected 't, x, y, z, qw, qx, qy, qz', got " + counted(fields.size(), "field"));
  }
  const std::int64_t time_ns = nanoseconds(line, fields[0]);
  fields[0] = "0";
  const auto v = reals<8>(line, fields);
  return {time_ns,
          {{v[1], v[2], v[3]}, quaternion(line, v[4], v[5], v[6], v[7], "qw, qx, qy, qz")}};
}

SpatialPose kitti_pose(const LineOfFile& line) {
  const Fields fields = split(line.text());
  if (fields.size() != 12) {
    line.refuse("expected the 12 numbers of a 3 x 4 matrix by rows, got " +
                counted(fields.size(), "field"));
  }
  const auto v = reals<12>(line, fields);
  Eigen::Matrix3d matrix;
  matrix << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
  return {{v[3], v[7], v[11]}, nearest_rotation(line, matrix)};
}

}  // namespace fathom
