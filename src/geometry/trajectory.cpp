#include "fathom/geometry/trajectory.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {

std::vector<std::size_t> consecutive(std::size_t begin, std::size_t end) {
  std::vector<std::size_t> keyframes(end - begin);
  std::iota(keyframes.begin(), keyframes.end(), begin);
  return keyframes;
}

// Its revision is its length.
MovedPoses GivenTrajectory::moved_since(std::uint64_t revision) const {
  return {poses_.size(), consecutive(revision, poses_.size())};
}

std::vector<Pose> poses_of(const TrajectoryView& view) {
  std::vector<Pose> poses;
  poses.reserve(view.size());
  for (std::size_t k = 0; k < view.size(); ++k) poses.push_back(view.pose(k));
  return poses;
}

std::vector<Pose> compose_trajectory(const Pose& origin, std::span<const Pose> motions) {
  std::vector<Pose> poses{origin};
  poses.reserve(motions.size() + 1);
  for (const Pose& motion : motions) poses.push_back(compose(poses.back(), motion));
  return poses;
}

std::string to_tum(std::span<const StampedPose> trajectory) {
  std::string text = "# t x y z qx qy qz qw\n";
  for (const StampedPose& stamped : trajectory) {
    const Pose& pose = stamped.pose;
    text += seconds_text(stamped.time_ns) + ' ' + exact(pose.x) + ' ' + exact(pose.y) + " 0 0 0 " +
            exact(std::sin(pose.theta / 2)) + ' ' + exact(std::cos(pose.theta / 2)) + '\n';
  }
  return text;
}

namespace {

// Decimal seconds as nanoseconds. A double holds a Unix time only to some 100 ns, the 64 bits of a
// long double hold it to the nanosecond.
std::optional<std::int64_t> parse_nanoseconds(std::string_view seconds) {
  const auto approximate = parse_real(seconds);
  if (!approximate || std::abs(*approximate) > 9e9) return std::nullopt;
  if (seconds.front() == '+') seconds.remove_prefix(1);
  long double value = 0.0L;
  std::from_chars(seconds.data(), seconds.data() + seconds.size(), value);
  return static_cast<std::int64_t>(std::llround(value * 1e9L));
}

class TumReader {
 public:
  explicit TumReader(std::string name) : name_(std::move(name)) {}

  std::vector<StampedPose> read(std::string_view content) {
    for (std::size_t begin = 0; begin < content.size();) {
      const std::size_t end = std::min(content.find('\n', begin), content.size());
      ++line_;
      read_line(content.substr(begin, end - begin));
      begin = end + 1;
    }
    return std::move(trajectory_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(name_, line_, what); }

  void read_line(std::string_view line) {
    const auto fields = split(line.substr(0, line.find('#')));
    if (fields.empty()) return;
    if (fields.size() != 8) {
      fail("expected 't x y z qx qy qz qw', got " + std::to_string(fields.size()) + " fields");
    }
    std::array<double, 8> v{};
    for (std::size_t i = 0; i < v.size(); ++i) {
      const auto number = parse_real(fields[i]);
      if (!number) fail(in_quotes(fields[i]) + " is not a finite number");
      v[i] = *number;
    }
    const auto time_ns = parse_nanoseconds(fields[0]);
    if (!time_ns) fail("the time stamp " + in_quotes(fields[0]) + " is not in seconds");
    if (!trajectory_.empty() && *time_ns <= trajectory_.back().time_ns) {
      fail("time stamps must rise from line to line");
    }
    trajectory_.push_back({*time_ns, {v[1], v[2], yaw(v[4], v[5], v[6], v[7])}});
  }

  double yaw(double qx, double qy, double qz, double qw) const {
    const double norm_squared = qx * qx + qy * qy + qz * qz + qw * qw;
    // Few digits are no fault; what is far from 1 is no quaternion, or another column.
    if (!(norm_squared > 0.5 && norm_squared < 2.0)) {
      fail("qx qy qz qw must have length 1, not " + std::to_string(std::sqrt(norm_squared)));
    }
    return wrap_angle(
        std::atan2(2.0 * (qw * qz + qx * qy), norm_squared - 2.0 * (qy * qy + qz * qz)));
  }

  std::string name_;
  std::size_t line_ = 0;
  std::vector<StampedPose> trajectory_;
};

}  // namespace

std::vector<StampedPose> read_tum(const std::filesystem::path& path) {
  return TumReader(path.string()).read(read_text(path));
}

}  // namespace fathom
