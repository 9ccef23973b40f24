#include "meridian_cut.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fathom {
namespace {

// Beyond ±180° rather than around the Earth: each longitude within half a turn of the one before.
std::vector<LonLat> unwrapped(std::vector<LonLat> places) {
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double step = places[i].x() - places[i - 1].x();
    places[i].x() -= 360.0 * std::round(step / 360.0);
  }
  return places;
}

// Which turn of the Earth a longitude lies on: 0 from −180 to 180.
double turn_of(double longitude) {
  return std::round(longitude / 360.0);
}

LonLat crossing(const LonLat& from, const LonLat& to, double longitude) {
  const double share = (longitude - from.x()) / (to.x() - from.x());
  return {longitude, from.y() + share * (to.y() - from.y())};
}

// The part of a convex polygon with sign · longitude ≤ sign · border.
std::vector<LonLat> part_of(const std::vector<LonLat>& ring, double border, double sign) {
  std::vector<LonLat> part;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const LonLat& here = ring[i];
    const LonLat& next = ring[(i + 1) % ring.size()];
    const bool is_in = sign * here.x() <= sign * border;
    if (is_in) part.push_back(here);
    if (is_in != (sign * next.x() <= sign * border)) part.push_back(crossing(here, next, border));
  }
  return part;
}

// On turn 0, counter-clockwise, closed.
std::vector<LonLat> closed_ring(std::vector<LonLat> ring) {
  double middle = 0.0;
  double twice_area = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const LonLat to = ring[(i + 1) % ring.size()] - ring[0];
    const LonLat from = ring[i] - ring[0];
    twice_area += from.x() * to.y() - from.y() * to.x();
    middle += ring[i].x() / static_cast<double>(ring.size());
  }
  if (twice_area < 0.0) std::reverse(ring.begin() + 1, ring.end());
  for (LonLat& place : ring) place.x() -= 360.0 * turn_of(middle);
  ring.push_back(ring.front());
  return ring;
}

}  // namespace

std::vector<std::vector<LonLat>> cut_line(const std::vector<LonLat>& line) {
  std::vector<std::vector<LonLat>> parts{{}};
  const std::vector<LonLat> straight = unwrapped(line);
  double turn = straight.empty() ? 0.0 : turn_of(straight.front().x());
  for (std::size_t i = 0; i < straight.size(); ++i) {
    const double next = turn_of(straight[i].x());
    if (i > 0 && next != turn) {
      const double border = 180.0 * (turn + next);
      const LonLat cut = crossing(straight[i - 1], straight[i], border);
      parts.back().emplace_back(cut.x() - 360.0 * turn, cut.y());
      parts.push_back({{cut.x() - 360.0 * next, cut.y()}});
      turn = next;
    }
    parts.back().emplace_back(straight[i].x() - 360.0 * turn, straight[i].y());
  }
  return parts;
}

std::vector<std::vector<LonLat>> cut_polygon(const std::vector<LonLat>& ring) {
  const std::vector<LonLat> straight = unwrapped(ring);
  const auto [low, high] = std::ranges::minmax(straight, {}, [](const LonLat& p) { return p.x(); });
  const double border = 180.0 * (turn_of(low.x()) + turn_of(high.x()));
  // One that only touches the antimeridian is whole.
  const bool is_cut = low.x() < border && border < high.x() && turn_of(low.x()) < turn_of(high.x());
  if (!is_cut) return {closed_ring(straight)};
  return {closed_ring(part_of(straight, border, 1.0)),
          closed_ring(part_of(straight, border, -1.0))};
}

}  // namespace fathom
