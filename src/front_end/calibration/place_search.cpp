#include "place_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fathom/core/median.hpp"

namespace fathom {
namespace {

// The price of a motion that nothing is held against: that of a wrong one.
constexpr double kUnknown = 11.0;

// What a change to any place at all has besides: of many stretches that look alike, such as
// straight ones, some fits better by the chance of dead reckoning's noise.
constexpr double kFarChange = 15.0;

struct Arrival {
  std::size_t frame = 0;
  const SeenMotion* motion = nullptr;  // from the one before, where it registers
};

std::vector<Arrival> arrivals_of(const std::vector<SeenMotion>& motions) {
  std::vector<Arrival> arrivals;
  for (const SeenMotion& motion : motions) {
    if (arrivals.empty() || arrivals.back().frame != motion.from) {
      arrivals.push_back({motion.from, nullptr});
    }
    arrivals.push_back({motion.to, &motion});
  }
  return arrivals;
}

class Search {
 public:
  // The spread where it is known; else that of the order as it is.
  Search(const CalibrationInput& input, const OdometryTrack& track, const SetUpParameters& set_up,
         const std::optional<ResidualSpread>& spread)
      : input_(input),
        track_(track),
        set_up_(set_up),
        places_(input.frame_times_ns),
        change_(price_of_block(places_.size())) {
    std::vector<double> times_s;
    for (const SeenMotion& motion : input.motions) times_s.push_back(seconds_of(motion));
    median_s_ = upper_median(times_s);
    spread_ = spread ? *spread : spread_of(as_they_are(), set_up_);
  }

  std::vector<MovedPictures> moved() {
    std::vector<MovedPictures> blocks = settled(searched());
    if (blocks.size() < 2) return blocks;
    // Where a way is gone twice, others may have been put on the places of the greatest block.
    greatest_ = *std::ranges::max_element(
        blocks, {}, [](const MovedPictures& block) { return block.last - block.first; });
    return settled(searched());
  }

 private:
  static constexpr double kTwice = 3.0;  // the price of a place that is taken twice

  std::vector<MovedPictures> searched() const {
    const std::vector<Arrival> arrivals = arrivals_of(input_.motions);
    std::vector<std::vector<std::size_t>> from;
    std::vector<double> cost(places_.size(), change_);
    cost[Places::of(arrivals.front().frame)] = 0.0;
    add_taken(arrivals.front().frame, cost);
    for (std::size_t i = 1; i < arrivals.size(); ++i) {
      from.emplace_back();
      cost = arrived(cost, arrivals[i - 1].frame, arrivals[i], from.back());
      add_taken(arrivals[i].frame, cost);
    }
    auto place = static_cast<std::size_t>(std::ranges::min_element(cost) - cost.begin());
    std::vector<MovedPictures> blocks;
    for (std::size_t i = arrivals.size(); i-- > 0;) {
      add(arrivals[i].frame, place, blocks);
      if (i > 0) place = from[i - 1][place];
    }
    std::ranges::reverse(blocks);
    return blocks;
  }

  // To the costs of a picture's places, where another picture of the greatest block is.
  void add_taken(std::size_t frame, std::vector<double>& cost) const {
    if (!greatest_) return;
    for (std::size_t f = greatest_->first; f <= greatest_->last; ++f) {
      if (f != frame) cost[Places::of(f, {*greatest_})] += kTwice;
    }
  }

  // A change to places near by is held against the motion, one to others is not.
  static constexpr std::ptrdiff_t kNear = 3;

  std::vector<Beside> as_they_are() const {
    std::vector<Beside> beside;
    for (const SeenMotion& motion : input_.motions) {
      const auto one = this->beside(motion, motion.from_ns, motion.to_ns);
      if (one) beside.push_back(*one);
    }
    return beside;
  }

  std::optional<Beside> beside(const SeenMotion& motion, std::int64_t from_ns,
                               std::int64_t to_ns) const {
    const std::int64_t shift_ns = nanoseconds(set_up_.time_offset_s);
    const auto reckoned = track_.motion(from_ns - shift_ns, to_ns - shift_ns);
    if (!reckoned) return std::nullopt;
    const double time_s = 1e-9 * std::abs(static_cast<double>(to_ns - from_ns));
    return Beside{0, motion.camera, *reckoned, Eigen::Vector3d::Zero(),
                  std::sqrt(time_s / median_s_)};
  }

  double misfit(const SeenMotion& motion, std::size_t from, std::size_t to) const {
    const auto one = beside(motion, places_.time_ns(from), places_.time_ns(to));
    if (!one) return kUnknown;
    return -ResidualSpread::kT.log_density(spread_.squared(residual_of(*one, set_up_)));
  }

  // Costs of the places of a picture, given those of the one before it.
  std::vector<double> arrived(const std::vector<double>& before, std::size_t frame_before,
                              const Arrival& arrival, std::vector<std::size_t>& from) const {
    const std::size_t places = places_.size();
    const auto best = static_cast<std::size_t>(std::ranges::min_element(before) - before.begin());
    const double far = before[best] + change_ + kFarChange;
    std::vector<double> cost(places, far);
    from.assign(places, best);
    const auto step = static_cast<std::ptrdiff_t>(arrival.frame - frame_before);
    for (std::size_t at = 0; at < places; ++at) {
      // What was reached by a far jump has no second change.
      const std::ptrdiff_t near =
          arrival.motion != nullptr && before[at] < before[best] + change_ ? kNear : 0;
      for (std::ptrdiff_t change = -near; change <= near; ++change) {
        const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(at) + step + change;
        if (to < 0 || to >= std::ssize(cost) || step + change == 0) continue;
        const auto there = static_cast<std::size_t>(to);
        double total = before[at] + (change != 0 ? change_ : 0.0);
        if (!(total < cost[there])) continue;
        if (arrival.motion != nullptr) total += misfit(*arrival.motion, at, there);
        if (!(total < cost[there])) continue;
        cost[there] = total;
        from[there] = at;
      }
    }
    return cost;
  }

  // What a sequence of blocks costs: as the way to it, and for places that are taken twice.
  double cost_of(const std::vector<MovedPictures>& blocks) const {
    double cost = change_ * static_cast<double>(blocks.size());
    if (blocks.front().places == 0) cost -= change_;
    for (const SeenMotion& motion : input_.motions) {
      cost += misfit(motion, Places::of(motion.from, blocks), Places::of(motion.to, blocks));
    }
    std::vector<bool> is_taken(places_.size(), false);
    for (const MovedPictures& block : blocks) {
      for (std::size_t frame = block.first; frame <= block.last; ++frame) {
        const std::size_t place = Places::of(frame, {block});
        if (is_taken[place]) cost += kTwice;
        is_taken[place] = true;
      }
    }
    return cost;
  }

  // With blocks that go with the one before or after them, as long as that costs less.
  std::vector<MovedPictures> settled(std::vector<MovedPictures> blocks) const {
    // Of so many nothing is to be learnt.
    if (3 * blocks.size() > input_.motions.size()) return {};
    double least = cost_of(blocks);
    while (true) {
      std::vector<MovedPictures> best;
      for (std::size_t i = 0; i + 1 < blocks.size(); ++i) {
        for (const std::ptrdiff_t places : {blocks[i].places, blocks[i + 1].places}) {
          std::vector<MovedPictures> fewer = blocks;
          fewer[i] = {blocks[i].first, blocks[i + 1].last, places};
          fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i) + 1);
          if (!places_.are_for(fewer[i])) continue;
          const double cost = cost_of(fewer);
          if (!(cost < least)) continue;
          least = cost;
          best = std::move(fewer);
        }
      }
      if (best.empty()) return blocks;
      blocks = std::move(best);
    }
  }

  // From the last picture to the first.
  static void add(std::size_t frame, std::size_t place, std::vector<MovedPictures>& moved) {
    const std::ptrdiff_t places =
        static_cast<std::ptrdiff_t>(place) - static_cast<std::ptrdiff_t>(Places::of(frame));
    if (!moved.empty() && moved.back().places == places) {
      moved.back().first = frame;
    } else {
      moved.push_back({frame, frame, places});
    }
  }

  const CalibrationInput& input_;
  const OdometryTrack& track_;
  SetUpParameters set_up_;
  Places places_;
  double change_ = 0.0;
  double median_s_ = 1.0;
  ResidualSpread spread_;
  std::optional<MovedPictures> greatest_;  // of a first search
};

}  // namespace

Places::Places(const std::vector<std::int64_t>& times_ns) {
  std::vector<double> intervals_ns;
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    intervals_ns.push_back(static_cast<double>(times_ns[i] - times_ns[i - 1]));
  }
  const auto interval_ns = static_cast<std::int64_t>(upper_median(intervals_ns));
  for (std::int64_t i = -kBeyond; i < std::ssize(times_ns) + kBeyond; ++i) {
    const auto inside = std::clamp<std::int64_t>(i, 0, std::ssize(times_ns) - 1);
    times_ns_.push_back(times_ns[static_cast<std::size_t>(inside)] + (i - inside) * interval_ns);
  }
}

std::size_t Places::of(std::size_t picture, const std::vector<MovedPictures>& blocks) {
  const auto block = std::ranges::find_if(blocks, [picture](const MovedPictures& b) {
    return b.first <= picture && picture <= b.last;
  });
  const std::ptrdiff_t places = block != blocks.end() ? block->places : 0;
  return of(picture) + static_cast<std::size_t>(places);
}

bool Places::are_for(const MovedPictures& block) const {
  return static_cast<std::ptrdiff_t>(of(block.first)) + block.places >= 0 &&
         static_cast<std::ptrdiff_t>(of(block.last)) + block.places < std::ssize(times_ns_);
}

double price_of_block(std::size_t places) {
  constexpr double kOfOne = 6.0;
  return kOfOne + std::log(static_cast<double>(places));
}

std::vector<MovedPictures> most_likely_places(const CalibrationInput& input,
                                              const OdometryTrack& track,
                                              const SetUpParameters& set_up,
                                              const std::optional<ResidualSpread>& spread) {
  return Search(input, track, set_up, spread).moved();
}

}  // namespace fathom
