#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "fathom/core/random.hpp"
#include "support/pairs/conditions.hpp"

namespace fathom::test {

/// A share of overlap of at least `low` and below `high`.
struct Bucket {
  double low = 0.0;
  double high = 1.0;
};

/// [0, 0.1), [0.1, 0.2) … [0.9, 1).
std::vector<Bucket> tenths();

/// Two level views of one world.
struct ViewPair {
  View a;
  View b;
  double overlap = 0.0;  ///< footprint_overlap, of the smaller footprint

  /// The true pose of b's body in the frame of a's.
  Pose motion() const { return between(a.pose, b.pose); }
};

/// Of the lowest view that draw_pairs and draw_view draw; metres.
double finest_pixel_of_pairs_m(const Camera& camera);

/// One view and partners that overlap with it, one in each bucket. The ratio of altitudes is
/// log-uniform in [1/2, 2] and the same for all of them, its geometric mean kNominalAltitudeM; the
/// overlap is uniform in its bucket; headings are uniform (those of a partner among the headings at
/// which there is such an overlap), as is the direction in which a partner lies. Footprints stay
/// inside `world` less a margin, the axes of which are the poses' own. Throws InputError where the
/// world is too small.
std::vector<ViewPair> draw_pairs(const Camera& camera, const Eigen::AlignedBox2d& world,
                                 const std::vector<Bucket>& buckets, RandomStream& stream);

/// A view anywhere in the world at a heading, or at a random one; its altitude is log-uniform
/// within 2^±½ of kNominalAltitudeM.
View draw_view(const Camera& camera, const Eigen::AlignedBox2d& world,
               const std::optional<double>& heading_rad, RandomStream& stream);

/// What the centres of a world's pixels span; metres. Poses in it need a world whose mission frame
/// is that of its picture.
Eigen::AlignedBox2d extent_of(const World& world);

}  // namespace fathom::test
