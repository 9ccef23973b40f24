#include "stamped_topic.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/asl_files.hpp"

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
  if (record_ns < -kMostTimeNs || record_ns > kMostTimeNs) {
    throw InputError(fmt::format("topic {}: a message was recorded at {} ns; the limit is {} ns",
                                 name_, record_ns, kMostTimeNs));
  }
  const Time time{stamp_ns.value_or(record_ns), record_ns - stamp_ns.value_or(record_ns)};
  const auto place = std::ranges::upper_bound(times_, time.time_ns, {}, &Time::time_ns);
  const bool is_repeated = place != times_.begin() && std::prev(place)->time_ns == time.time_ns;
  if (place != times_.end()) {
    require_little_late(time, is_repeated);
  } else if (is_repeated) {
    ++repeated_;
    return std::nullopt;
  } else {
    late_in_a_row_ = 0;
  }
  times_.insert(place, time);
  return time.time_ns;
}

void StampedTopic::require_little_late(const Time& late, bool is_repeated) {
  const std::int64_t newest_ns = times_.back().time_ns;
  const double late_s = static_cast<double>(newest_ns - late.time_ns) * kSecondsPerNs;
  ++late_;
  ++late_in_a_row_;
  most_late_s_ = std::max(most_late_s_, late_s);
  if (!is_repeated && late_s <= max_late_s_ && late_in_a_row_ <= max_late_in_a_row_) return;
  throw InputError(fmt::format("topic {}: time goes back from {} s to {} s at message {}{}; {}",
                               name_, seconds_text(newest_ns), seconds_text(late.time_ns),
                               times_.size() + repeated_ + 1,
                               is_repeated ? ", a time that was there" : "", kRemedy));
}

double StampedTopic::delay_s() const {
  if (times_.empty()) return 0.0;
  std::vector<std::int64_t> sorted;
  sorted.reserve(times_.size());
  for (const Time& time : times_) sorted.push_back(time.delay_ns);
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::ranges::nth_element(sorted, middle);
  return static_cast<double>(*middle) * kSecondsPerNs;
}

void StampedTopic::check_rate() const {
  constexpr double kShortest = 1.0;     // seconds: of less nothing can be said
  constexpr double kMostRatio = 100.0;  // between a clock and another one, both in the same unit
  if (clock_ != BagClock::automatic || times_.size() < 2) return;
  const double span_s =
      static_cast<double>(times_.back().time_ns - times_.front().time_ns) * kSecondsPerNs;
  const double recorded_s =
      span_s +
      static_cast<double>(times_.back().delay_ns - times_.front().delay_ns) * kSecondsPerNs;
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
