#include <algorithm>
#include <cmath>
#include <vector>

#include "fathom/vision/camera.hpp"

namespace fathom {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Positive: counter-clockwise.
double signed_area(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    twice += cross(polygon[i] - polygon[0], polygon[(i + 1) % polygon.size()] - polygon[0]);
  }
  return 0.5 * twice;
}

Polygon counter_clockwise(const Camera& camera, const Stance& stance, const Pose& pose) {
  constexpr int kStepsASide = 8;
  Polygon corners;
  if (camera.model().has_straight_sides()) {
    for (const Eigen::Vector2d& corner : camera.footprint(stance)) {
      corners.push_back(transform(pose, corner));
    }
  } else {
    corners = camera.outline(stance, kStepsASide);
    for (Eigen::Vector2d& corner : corners) corner = transform(pose, corner);
  }
  if (signed_area(corners) < 0.0) std::reverse(corners.begin(), corners.end());
  return corners;
}

// What of a polygon lies to the left of the line from a to b, or on it.
Polygon left_of(const Polygon& polygon, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  Polygon left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& here = polygon[i];
    const Eigen::Vector2d& next = polygon[(i + 1) % polygon.size()];
    const double side_here = cross(b - a, here - a);
    const double side_next = cross(b - a, next - a);
    if (side_here >= 0.0) left.push_back(here);
    if ((side_here > 0.0 && side_next < 0.0) || (side_here < 0.0 && side_next > 0.0)) {
      left.push_back(here + side_here / (side_here - side_next) * (next - here));
    }
  }
  return left;
}

// What of a polygon lies in a convex one, both counter-clockwise.
double shared_area(Polygon polygon, const Polygon& convex) {
  for (std::size_t i = 0; i < convex.size() && !polygon.empty(); ++i) {
    polygon = left_of(polygon, convex[i], convex[(i + 1) % convex.size()]);
  }
  return polygon.size() < 3 ? 0.0 : signed_area(polygon);
}

// The same for any two. The second is a sum of triangles from its first corner, those outside of it
// taken off again; of a polygon that is not convex a cut may leave parts joined by a seam, which
// has no area.
double shared_area_of_bent(const Polygon& a, const Polygon& b) {
  double shared = 0.0;
  for (std::size_t i = 1; i + 1 < b.size(); ++i) {
    Polygon triangle{b[0], b[i], b[i + 1]};
    const bool is_taken_off = signed_area(triangle) < 0.0;
    if (is_taken_off) std::swap(triangle[1], triangle[2]);
    shared += (is_taken_off ? -1.0 : 1.0) * shared_area(a, triangle);
  }
  return shared;
}

}  // namespace

// Clipped side by side (Sutherland and Hodgman), and not by OpenCV's intersectConvexConvex, which
// fails where sides lie on one another, as those of parallel legs do: 0 in place of 0.75.
double footprint_overlap(const Camera& camera, const Stance& stance_a, const Stance& stance_b,
                         const Pose& motion) {
  const Polygon a = counter_clockwise(camera, stance_a, {});
  const Polygon b = counter_clockwise(camera, stance_b, motion);
  const double shared =
      camera.model().has_straight_sides() ? shared_area(a, b) : shared_area_of_bent(a, b);
  // Unmoved: far away its area would be lost in rounding.
  const double area_b = signed_area(counter_clockwise(camera, stance_b, {}));
  return std::clamp(shared / std::min(signed_area(a), area_b), 0.0, 1.0);
}

}  // namespace fathom
