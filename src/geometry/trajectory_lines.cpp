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
  if (!number) line.refuse(in_quotes(field) + " is not a finite number");
  return *number;
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

std::vector<LineOfFile> lines_of(std::string_view content, const std::string& name) {
  std::vector<LineOfFile> lines;
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < content.size();) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    std::string_view line = content.substr(begin, end - begin);
    line = trim(line.substr(0, line.find('#')));
    ++number;
    if (!line.empty()) lines.emplace_back(name, number, line);
    begin = end + 1;
  }
  return lines;
}

// A double holds a Unix time only to some 100 ns, the 64 bits of a long double hold it to the
// nanosecond.
std::int64_t time_of(const LineOfFile& line, std::string_view seconds) {
  const double approximate = real(line, seconds);
  if (std::abs(approximate) > 9e9) {
    line.refuse(fmt::format("the time stamp {} is not in seconds{}", in_quotes(seconds),
                            approximate > 9e16 ? " but, it seems, nanoseconds" : ""));
  }
  if (seconds.front() == '+') seconds.remove_prefix(1);
  long double value = 0.0L;
  std::from_chars(seconds.data(), seconds.data() + seconds.size(), value);
  return static_cast<std::int64_t>(std::llround(value * 1e9L));
}

StampedSpatialPose tum_pose(const LineOfFile& line) {
  const Fields fields = split(line.text());
  if (fields.size() != 8) {
    line.refuse("expected 't x y z qx qy qz qw', got " + std::to_string(fields.size()) + " fields");
  }
  const auto v = reals<8>(line, fields);
  return {time_of(line, fields[0]),
          {{v[1], v[2], v[3]}, quaternion(line, v[7], v[4], v[5], v[6], "qx qy qz qw")}};
}

StampedSpatialPose euroc_pose(const LineOfFile& line) {
  Fields fields = split_csv(line.text());
  if (fields.size() < 8) {
    line.refuse("expected 't, x, y, z, qw, qx, qy, qz', got " + std::to_string(fields.size()) +
                " fields");
  }
  const auto time_ns = parse_integer(fields[0]);
  if (!time_ns) {
    line.refuse("the time stamp " + in_quotes(fields[0]) + " is not in whole nanoseconds");
  }
  fields[0] = "0";
  const auto v = reals<8>(line, fields);
  return {*time_ns,
          {{v[1], v[2], v[3]}, quaternion(line, v[4], v[5], v[6], v[7], "qw, qx, qy, qz")}};
}

SpatialPose kitti_pose(const LineOfFile& line) {
  const Fields fields = split(line.text());
  if (fields.size() != 12) {
    line.refuse("expected the 12 numbers of a 3 x 4 matrix by rows, got " +
                std::to_string(fields.size()) + " fields");
  }
  const auto v = reals<12>(line, fields);
  Eigen::Matrix3d matrix;
  matrix << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
  return {{v[3], v[7], v[11]}, nearest_rotation(line, matrix)};
}

}  // namespace fathom
