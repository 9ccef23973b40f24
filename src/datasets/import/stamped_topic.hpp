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
  StampedTopic(std::string name, const BagImportOptions& options)
      : name_(std::move(name)),
        clock_(options.clock),
        max_late_s_(options.max_late_s),
        max_late_in_a_row_(options.max_late_in_a_row) {}

  /// The time that counts of the next message; nothing where it repeats the newest. It may be
  /// before the newest by little (BagImportOptions::max_late_s). Throws InputError where it goes
  /// back further or to a time that was there, and where the header has no time.
  std::optional<std::int64_t> next(std::int64_t record_ns, std::optional<std::int64_t> stamp_ns);

  const std::string& name() const { return name_; }
  std::size_t repeated() const { return repeated_; }
  /// Messages that came after newer ones, and by how much at most.
  std::size_t late() const { return late_; }
  double most_late_s() const { return most_late_s_; }

  /// How far the times that count are behind those of recording, in the median: 0 of a topic
  /// without headers.
  double delay_s() const;

  /// Throws InputError where the times that count run at another rate than those of recording, as
  /// seconds do where nanoseconds belong.
  void check_rate() const;

 private:
  std::string name_;
  BagClock clock_ = BagClock::automatic;
  double max_late_s_ = 0.0;
  std::size_t max_late_in_a_row_ = 0;
  struct Time {
    std::int64_t time_ns = 0;
    std::int64_t delay_ns = 0;  ///< from then to recording
  };
  void require_little_late(const Time& late, bool is_repeated);

  std::vector<Time> times_;  ///< in order
  std::size_t repeated_ = 0;
  std::size_t late_ = 0;
  std::size_t late_in_a_row_ = 0;
  double most_late_s_ = 0.0;
};

/// Throws InputError that names the topic and the offset where its clock differs from that of the
/// pictures by more than `max_offset_s`.
void check_clocks(const StampedTopic& pictures, const StampedTopic& other, double max_offset_s);

}  // namespace fathom
