#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "fathom/front_end/calibration.hpp"
#include "odometry_track.hpp"

namespace fathom {

/// Headings of a source, as it gives them.
class HeadingTrack {
 public:
  void add(std::int64_t time_ns, double heading_rad) {
    times_ns_.push_back(time_ns);
    headings_rad_.push_back(heading_rad);
  }
  std::size_t size() const { return times_ns_.size(); }
  std::int64_t time_ns(std::size_t i) const { return times_ns_[i]; }

  double turn_rad(std::size_t from, std::size_t to) const {
    return wrap_angle(headings_rad_[to] - headings_rad_[from]);
  }

 private:
  std::vector<std::int64_t> times_ns_;
  std::vector<double> headings_rad_;
};

/// Pairs of readings so far apart, each beginning where the one before ends.
std::vector<std::pair<std::size_t, std::size_t>> spans(const HeadingTrack& said, double span_s);

/// How dead reckoning turns between two readings whose times are so much later.
std::optional<double> reckoned_turn(const HeadingTrack& said, const OdometryTrack& track,
                                    std::size_t from, std::size_t to, double offset_s);

/// The clock at which headings turn as dead reckoning does (`sense` 1, or −1 the other way): the
/// most likely of a grid up to 5 s, then by iteratively reweighted least squares.
std::optional<Estimated> clock_of(const HeadingTrack& said, const OdometryTrack& track,
                                  double sense);

}  // namespace fathom
