#include "fathom/front_end/repeated_keypoints.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fathom {
namespace {

// Evenly spread over a picture, wider than high as most are.
constexpr int kAcross = 20;
constexpr int kDown = 15;
constexpr std::size_t kSamples = std::size_t{kAcross} * kDown;

// What one of the pictures of a registration has in common with the other.
struct End {
  std::size_t registration = 0;
  std::vector<bool> is_common = std::vector<bool>(kSamples);  // by sample of the picture
  double density = 0.0;                                       // inliers a common sample

  std::size_t common() const {
    return static_cast<std::size_t>(std::ranges::count(is_common, true));
  }
};

class Pictures {
 public:
  Pictures(const Camera& camera, std::span<const Stance> stances)
      : camera_(camera), stances_(stances), ends_(stances.size()) {
    const CameraModel& model = camera.model();
    std::vector<Eigen::Vector2d> pixels;
    for (int row = 0; row < kDown; ++row) {
      for (int column = 0; column < kAcross; ++column) {
        pixels.emplace_back((column + 0.5) / kAcross * model.width - 0.5,
                            (row + 0.5) / kDown * model.height - 0.5);
      }
    }
    for (const Stance& stance : stances) samples_.push_back(camera.floor_points(pixels, stance));
  }

  void add(const RelativePose& z, std::size_t registration) {
    ends_[z.from].push_back(end_of(z, registration, z.from, z.to, inverse(z.motion)));
    ends_[z.to].push_back(end_of(z, registration, z.to, z.from, z.motion));
  }

  /// Adds to each registration of the picture in how many a keypoint of it takes part, over both of
  /// its pictures half each.
  void count(std::size_t picture, std::vector<double>& registrations) const {
    const std::vector<End>& ends = ends_[picture];
    // Of a sliver in common the density is no number to go by.
    constexpr std::size_t kFewest = kSamples / 10;
    double densest = 0.0;
    for (const End& end : ends) {
      if (end.common() >= kFewest) densest = std::max(densest, end.density);
    }
    const auto share_of = [densest](const End& end) {
      return densest > 0.0 ? std::min(1.0, end.density / densest) : 1.0;
    };
    std::vector<double> matched(kSamples, 0.0);
    for (const End& end : ends) {
      for (std::size_t s = 0; s < kSamples; ++s) {
        if (end.is_common[s]) matched[s] += share_of(end);
      }
    }
    for (const End& end : ends) {
      const std::size_t common = end.common();
      double sum = 0.0;
      for (std::size_t s = 0; s < kSamples; ++s) {
        if (end.is_common[s]) sum += matched[s] - share_of(end) + 1.0;
      }
      registrations[end.registration] +=
          0.5 * (common > 0 ? sum / static_cast<double>(common) : 1.0);
    }
  }

  std::size_t size() const { return ends_.size(); }

 private:
  // `seen_from` is the picture in the axes of the other one.
  End end_of(const RelativePose& z, std::size_t registration, std::size_t picture,
             std::size_t other, const Pose& seen_from) const {
    End end;
    end.registration = registration;
    const CameraModel& model = camera_.model();
    const double reach_m = reach(other);
    for (std::size_t s = 0; s < kSamples; ++s) {
      const Eigen::Vector2d there = transform(seen_from, samples_[picture][s]);
      // Further off the distortion may bring a point back in. NaN is above the horizon.
      if (!((there - mount()).norm() <= reach_m)) continue;
      const Eigen::Vector2d pixel = camera_.pixel(there, stances_[other]);
      end.is_common[s] = pixel.x() >= -0.5 && pixel.x() <= model.width - 0.5 && pixel.y() >= -0.5 &&
                         pixel.y() <= model.height - 0.5;
    }
    const std::size_t common = end.common();
    if (z.inliers && common > 0) {
      end.density = static_cast<double>(*z.inliers) / static_cast<double>(common);
    }
    return end;
  }

  Eigen::Vector2d mount() const { return {camera_.model().mount_x_m, camera_.model().mount_y_m}; }

  // From the camera to beyond what the picture covers, by less than a cell of the grid.
  double reach(std::size_t picture) const {
    constexpr double kBeyond = 1.1;
    double reach_m = 0.0;
    for (const Eigen::Vector2d& point : samples_[picture]) {
      const double distance_m = (point - mount()).norm();
      if (distance_m > reach_m) reach_m = distance_m;
    }
    return kBeyond * reach_m;
  }

  const Camera& camera_;
  std::span<const Stance> stances_;
  std::vector<std::vector<Eigen::Vector2d>> samples_;  // by picture, on the floor
  std::vector<std::vector<End>> ends_;                 // by picture
};

}  // namespace

std::vector<double> repeats_of_keypoints(const MeasurementLog& log, const Camera& camera,
                                         std::span<const Stance> stances) {
  Pictures pictures(camera, stances);
  std::size_t count = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    for (const RelativePose& z : log.arrival(k).registrations) pictures.add(z, count++);
  }
  std::vector<double> registrations(count, 0.0);
  for (std::size_t k = 0; k < pictures.size(); ++k) pictures.count(k, registrations);
  for (double& one : registrations) one = 0.5 * (1.0 + one);
  return registrations;
}

MeasurementLog count_keypoints_once(const MeasurementLog& log, std::span<const double> repeats) {
  return with_registrations(
      log, [&](const RelativePose& z, std::size_t i) { return z.repeated(repeats[i]); });
}

}  // namespace fathom
