#include "stamped_topic.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

constexpr double kSecondsPerNs = 1e-9;

// What to do about header stamps that cannot be right.
const char* const kRemedy = "--clock record takes the times of recording in their place";

}  // namespace

std::optional<std::int64_t> StampedTopic::next(std::int64_t record_ns,
                                               std::optional<std::int64_t> stamp_ns) {
  if (clock_ == BagClock::record) stamp_ns.reset();
  if (stamp_ns == 0 && record_ns != 0) {
    throw InputError(fmt::format("topic {}: its header has no time stamp (0); {}", name_, kRemedy));
  }
  const std::int64_t time_ns = stamp_ns.value_or(record_ns);
  if (!times_ns_.empty() && time_ns == times_ns_.back()) {
    ++repeated_;
    return std::nullopt;
  }
  if (!times_ns_.empty() && time_ns < times_ns_.back()) {
    throw InputError(fmt::format("topic {}: time goes back from {} s to {} s at message {}; {}",
                                 name_, seconds_text(times_ns_.back()), seconds_text(time_ns),
                                 times_ns_.size() + repeated_ + 1, kRemedy));
  }
  times_ns_.push_back(time_ns);
  delays_ns_.push_back(record_ns - time_ns);
  return time_ns;
}

double StampedTopic::delay_s() const {
  if (delays_ns_.empty()) return 0.0;
  std::vector<std::int64_t> sorted = delays_ns_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::ranges::nth_element(sorted, middle);
  return static_cast<double>(*middle) * kSecondsPerNs;
}

void StampedTopic::check_rate() const {
  constexpr double kShortest = 1.0;     // seconds: of less nothing can be said
  constexpr double kMostRatio = 100.0;  // between a clock and another one, both in the same unit
  if (clock_ != BagClock::automatic || times_ns_.size() < 2) return;
  const double span_s = static_cast<double>(times_ns_.back() - times_ns_.front()) * kSecondsPerNs;
  const double recorded_s =
      span_s + static_cast<double>(delays_ns_.back() - delays_ns_.front()) * kSecondsPerNs;
  const bool is_like = span_s < kMostRatio * recorded_s && recorded_s < kMostRatio * span_s;
  if (is_like || std::max(span_s, recorded_s) < kShortest) return;
  throw InputError(fmt::format(
      "topic {}: its header stamps span {} s and its recording {} s; are they in another unit than "
      "seconds and nanoseconds? {}, --clock header takes the stamps as they are",
      name_, short_number(span_s), short_number(recorded_s), kRemedy));
}

void check_clocks(const StampedTopic& pictures, const StampedTopic& other, double max_offset_s) {
  // A later stamp makes a smaller delay.
  const double ahead_s = pictures.delay_s() - other.delay_s();
  if (std::abs(ahead_s) <= max_offset_s) return;
  throw InputError("two clocks disagree: against the times of recording, " + other.name() + " is " +
                   short_number(std::abs(ahead_s), 6) + " s " +
                   (ahead_s > 0.0 ? "ahead of " : "behind ") + pictures.name() + "; " + kRemedy +
                   ", --clock header takes all stamps as they are");
}

}  // namespace fathom
