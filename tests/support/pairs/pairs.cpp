#include "support/pairs/pairs.hpp"

#include <cmath>
#include <numbers>

#include "fathom/core/input_error.hpp"

namespace fathom::test {
namespace {

// For tilts and reliefs, which see a little beyond a level footprint.
constexpr double kMarginM = 0.5;
constexpr int kTries = 2000;

// Altitudes are log-uniform within so many octaves to either side of the nominal one.
constexpr double kOctaves = 0.5;

double any_angle(RandomStream& stream) {
  return stream.uniform(-std::numbers::pi, std::numbers::pi);
}

bool lies_inside(const Camera& camera, const View& view, const Eigen::AlignedBox2d& world) {
  for (const Eigen::Vector2d& corner : camera.footprint(view.altitude_m)) {
    const Eigen::Vector2d point = transform(view.pose, corner);
    const Eigen::Vector2d room = (point - world.min()).cwiseMin(world.max() - point);
    if (room.minCoeff() < kMarginM) return false;
  }
  return true;
}

[[noreturn]] void refuse_world(const Eigen::AlignedBox2d& world) {
  throw InputError("a world of " + std::to_string(world.sizes().x()) + " by " +
                   std::to_string(world.sizes().y()) + " m is too small for these views");
}

View place(const Camera& camera, const Eigen::AlignedBox2d& world, View view,
           const std::optional<double>& heading_rad, RandomStream& stream) {
  for (int i = 0; i < kTries; ++i) {
    view.pose = {stream.uniform(world.min().x(), world.max().x()),
                 stream.uniform(world.min().y(), world.max().y()),
                 heading_rad ? *heading_rad : any_angle(stream)};
    if (lies_inside(camera, view, world)) return view;
  }
  refuse_world(world);
}

// Views overlap less and less on a straight way from each other: footprints are convex, and their
// common area is a concave function's square.
double distance_at(const Camera& camera, ViewPair pair, double direction_rad, double overlap) {
  double low_m = 0.0;
  double high_m = 16.0 * kNominalAltitudeM;
  for (int i = 0; i < 40; ++i) {
    const double middle_m = 0.5 * (low_m + high_m);
    pair.b.pose.x = pair.a.pose.x + middle_m * std::cos(direction_rad);
    pair.b.pose.y = pair.a.pose.y + middle_m * std::sin(direction_rad);
    const double here =
        footprint_overlap(camera, pair.a.altitude_m, pair.b.altitude_m, pair.motion());
    (here > overlap ? low_m : high_m) = middle_m;
  }
  return high_m;
}

ViewPair draw_partner(const Camera& camera, const Eigen::AlignedBox2d& world, const View& a,
                      double altitude_b_m, const Bucket& bucket, RandomStream& stream) {
  ViewPair pair{a, a};
  pair.b.altitude_m = altitude_b_m;
  const double overlap = stream.uniform(bucket.low, bucket.high);
  for (int i = 0; i < kTries; ++i) {
    pair.b.pose = {a.pose.x, a.pose.y, any_angle(stream)};
    const double direction_rad = any_angle(stream);
    const double most = footprint_overlap(camera, a.altitude_m, altitude_b_m, pair.motion());
    if (most < overlap) continue;
    const double distance_m = distance_at(camera, pair, direction_rad, overlap);
    pair.b.pose.x += distance_m * std::cos(direction_rad);
    pair.b.pose.y += distance_m * std::sin(direction_rad);
    if (!lies_inside(camera, pair.b, world)) continue;
    pair.overlap = footprint_overlap(camera, a.altitude_m, altitude_b_m, pair.motion());
    return pair;
  }
  refuse_world(world);
}

}  // namespace

std::vector<Bucket> tenths() {
  std::vector<Bucket> buckets;
  for (int k = 0; k < 10; ++k) buckets.push_back({0.1 * k, 0.1 * (k + 1)});
  return buckets;
}

std::vector<ViewPair> draw_pairs(const Camera& camera, const Eigen::AlignedBox2d& world,
                                 const std::vector<Bucket>& buckets, RandomStream& stream) {
  const double root_of_ratio = std::exp2(stream.uniform(-kOctaves, kOctaves));
  View a;
  a.altitude_m = kNominalAltitudeM * root_of_ratio;
  a = place(camera, world, a, std::nullopt, stream);
  std::vector<ViewPair> pairs;
  for (const Bucket& bucket : buckets) {
    pairs.push_back(
        draw_partner(camera, world, a, kNominalAltitudeM / root_of_ratio, bucket, stream));
  }
  return pairs;
}

View draw_view(const Camera& camera, const Eigen::AlignedBox2d& world,
               const std::optional<double>& heading_rad, RandomStream& stream) {
  View view;
  view.altitude_m = kNominalAltitudeM * std::exp2(stream.uniform(-kOctaves, kOctaves));
  return place(camera, world, view, heading_rad, stream);
}

double finest_pixel_of_pairs_m(const Camera& camera) {
  return finest_pixel_m(camera.model(), kNominalAltitudeM * std::exp2(-kOctaves));
}

Eigen::AlignedBox2d extent_of(const World& world) {
  const Eigen::Vector2d half{(world.picture.rows - 1) / 2.0 * world.metres_per_pixel,
                             (world.picture.cols - 1) / 2.0 * world.metres_per_pixel};
  return {-half, half};
}

}  // namespace fathom::test
