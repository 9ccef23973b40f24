#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fathom/datasets/import.hpp"

namespace fathom {

/// The times of one topic's messages, as they arrive.
class StampedTopic {
 public:
  StampedTopic() = default;
  StampedTopic(std::string name, BagClock clock) : name_(std::move(name)), clock_(clock) {}

  /// The time that counts of the next message; nothing where it repeats the one before. Throws
  /// InputError where it goes back, and where the header has no time.
  std::optional<std::int64_t> next(std::int64_t record_ns, std::optional<std::int64_t> stamp_ns);

  const std::string& name() const { return name_; }
  std::size_t repeated() const { return repeated_; }

  /// How far the times that count are behind those of recording, in the median: 0 of a topic
  /// without headers.
  double delay_s() const;

  /// Throws InputError where the times that count run at another rate than those of recording, as
  /// seconds do where nanoseconds belong.
  void check_rate() const;

 private:
  std::string name_;
  BagClock clock_ = BagClock::automatic;
  std::vector<std::int64_t> times_ns_;
  std::vector<std::int64_t> delays_ns_;
  std::size_t repeated_ = 0;
};

/// Throws InputError that names the topic and the offset where its clock differs from that of the
/// pictures by more than `max_offset_s`.
void check_clocks(const StampedTopic& pictures, const StampedTopic& other, double max_offset_s);

}  // namespace fathom
