#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fathom/front_end/calibration.hpp"
#include "odometry_track.hpp"
#include "residuals.hpp"

namespace fathom {

/// The times of the places in which pictures are, with some before the first one and after the
/// last.
class Places {
 public:
  explicit Places(const std::vector<std::int64_t>& times_ns);

  std::size_t size() const { return times_ns_.size(); }
  std::int64_t time_ns(std::size_t place) const { return times_ns_[place]; }
  /// That of a picture that belongs where it is.
  static std::size_t of(std::size_t picture) { return picture + kBeyond; }
  /// The one where it belongs.
  static std::size_t of(std::size_t picture, const std::vector<MovedPictures>& blocks);
  /// Whether there are places for all of them.
  bool are_for(const MovedPictures& block) const;

 private:
  static constexpr std::int64_t kBeyond = 30;
  std::vector<std::int64_t> times_ns_;
};

/// The price of one more block, in units of the log density: it is searched for at every place.
double price_of_block(std::size_t places);

/// The most likely places of pictures, given a set-up and the spread of motions under it (Viterbi):
/// a picture follows the one before it, and anything else has its price. Blocks of all pictures
/// that motions join, by rising number; none where there would be nearly as many as motions.
std::vector<MovedPictures> most_likely_places(const CalibrationInput& input,
                                              const OdometryTrack& track,
                                              const SetUpParameters& set_up,
                                              const std::optional<ResidualSpread>& spread);

}  // namespace fathom
