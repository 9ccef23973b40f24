#include "picture_order.hpp"

#include <algorithm>
#include <cmath>

#include "place_search.hpp"

namespace fathom {
namespace {

// Whether each picture has a place nearly of its own.
bool are_apart(const std::vector<MovedPictures>& blocks) {
  constexpr std::ptrdiff_t kShared = 3;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto first = [](const MovedPictures& b) {
        return static_cast<std::ptrdiff_t>(b.first) + b.places;
      };
      const auto last = [](const MovedPictures& b) {
        return static_cast<std::ptrdiff_t>(b.last) + b.places;
      };
      const std::ptrdiff_t shared = std::min(last(blocks[i]), last(blocks[j])) -
                                    std::max(first(blocks[i]), first(blocks[j])) + 1;
      if (shared > kShared) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<SeenMotion> put_in_place(const CalibrationInput& input,
                                     const std::vector<MovedPictures>& moved) {
  const Places places(input.frame_times_ns);
  std::vector<SeenMotion> motions = input.motions;
  for (SeenMotion& motion : motions) {
    motion.from_ns = places.time_ns(Places::of(motion.from, moved));
    motion.to_ns = places.time_ns(Places::of(motion.to, moved));
  }
  return motions;
}

double evidence_of(const CalibrationInput& input, const SetUpFit& fit) {
  return fit.log_density * static_cast<double>(fit.motions) /
         static_cast<double>(input.motions.size());
}

std::vector<MovedPictures> find_moved(const CalibrationInput& input, const OdometryTrack& track,
                                      const SetUpPrior& prior,
                                      const std::vector<SetUpParameters>& starts, double evidence) {
  // As of another way to read the rows.
  constexpr double kGain = 20.0;
  constexpr double kLate_s = 0.05;
  constexpr int kRounds = 2;
  const double price = price_of_block(input.frame_times_ns.size());
  std::vector<MovedPictures> best;
  double most = evidence + kGain;
  for (SetUpParameters set_up : starts) {
    std::optional<ResidualSpread> spread;
    for (int round = 0; round < kRounds; ++round) {
      const auto blocks = most_likely_places(input, track, set_up, spread);
      if (blocks.size() < 2 || !are_apart(blocks)) break;
      const auto fit = fit_set_up(put_in_place(input, blocks), track, prior);
      if (!fit) break;
      set_up = fit->value;
      spread = ResidualSpread{fit->sigma_m, fit->sigma_rad};
      double gained = evidence_of(input, *fit) - price * static_cast<double>(blocks.size() - 1);
      // All pictures one place later is a clock's as well.
      if (std::abs(set_up.time_offset_s) > kLate_s) gained -= price;
      if (!(gained > most)) continue;
      most = gained;
      best = blocks;
    }
  }
  std::erase_if(best, [](const MovedPictures& block) { return block.places == 0; });
  return best;
}

}  // namespace fathom
