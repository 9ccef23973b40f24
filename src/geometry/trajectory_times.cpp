#include "trajectory_times.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numeric>

#include "fathom/core/text.hpp"

namespace fathom {
namespace {

using Times = std::span<const std::int64_t>;
using Indices = std::vector<std::size_t>;

std::string_view stamp_text(const LineOfFile& line) {
  return line.text().substr(0, line.text().find_first_of(" \t,;"));
}

// What the digits of a number can tell.
struct Digits {
  std::ptrdiff_t count = 0;
  std::ptrdiff_t place =
      std::numeric_limits<std::ptrdiff_t>::max();  ///< of the last, a power of 10
};

Digits digits_of(std::string_view text) {
  const std::size_t exponent_at = std::min(text.find_first_of("eE"), text.size());
  const std::string_view mantissa = text.substr(0, exponent_at);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  // Zeros at the end are of whoever printed %f.
  std::size_t end = mantissa.size();
  if (exponent_at == text.size() && point < end) {
    end = std::max(mantissa.find_last_not_of('0') + 1, point + 1);
  }
  Digits digits;
  digits.place = -static_cast<std::ptrdiff_t>(end - std::min(point + 1, end));
  if (exponent_at < text.size()) {
    digits.place += parse_integer(text.substr(exponent_at + 1)).value_or(0);
  }
  const std::string_view kept = mantissa.substr(0, end);
  const std::size_t first = std::min(kept.find_first_of("123456789"), kept.size());
  digits.count = std::count_if(kept.begin() + static_cast<std::ptrdiff_t>(first), kept.end(),
                               [](char letter) { return letter != '.'; });
  digits.count = std::max<std::ptrdiff_t>(digits.count, 1);
  return digits;
}

Digits finest(std::span<const LineOfFile> lines) {
  Digits all;
  for (const LineOfFile& line : lines) {
    const Digits one = digits_of(stamp_text(line));
    all = {std::max(all.count, one.count), std::min(all.place, one.place)};
  }
  return all;
}

// They may be further apart than an integer of 64 bits can tell.
double step_s(std::int64_t from_ns, std::int64_t to_ns) {
  return (static_cast<double>(to_ns) - static_cast<double>(from_ns)) / 1e9;
}

double mean_step_s(Times times_ns) {
  double sum_s = 0.0;
  for (std::size_t k = 1; k < times_ns.size(); ++k) {
    sum_s += std::max(step_s(times_ns[k - 1], times_ns[k]), 0.0);
  }
  return sum_s / static_cast<double>(times_ns.size() - 1);
}

// Lines with the time of the one before.
Indices repeats_in(Times times_ns) {
  Indices repeats;
  for (std::size_t k = 1; k < times_ns.size(); ++k) {
    if (times_ns[k] == times_ns[k - 1]) repeats.push_back(k);
  }
  return repeats;
}

// Lines with a time before that of the one before: each begins a stretch.
Indices falls_in(Times times_ns) {
  Indices falls;
  for (std::size_t k = 1; k < times_ns.size(); ++k) {
    if (times_ns[k] < times_ns[k - 1]) falls.push_back(k);
  }
  return falls;
}

void refuse_few_digits(std::span<const LineOfFile> lines, Times times_ns, const StampRule& rule,
                       const Indices& repeats) {
  const Digits digits = finest(lines);
  const double resolution_s = rule.unit_s * std::pow(10.0, static_cast<double>(digits.place));
  if (resolution_s < mean_step_s(times_ns) / 2.0) return;
  const LineOfFile& line = lines[repeats.front()];
  line.refuse(fmt::format(
      "{} have {} between them, such as {}: too few digits ({}, which tell times {} s apart); "
      "expected all digits, to be written where the file was made{}",
      counted(lines.size(), "pose"), counted(lines.size() - repeats.size(), "time stamp"),
      in_quotes(stamp_text(line)), digits.count, short_number(resolution_s, 6),
      rule.unit_s == 1.0 ? ", with 9 decimals" : ""));
}

// Whether nothing but whole rows, pose and all, is repeated.
bool are_rows(std::span<const LineOfFile> lines, const StampRule& rule, const Indices& repeats) {
  return !rule.sort.empty() && std::all_of(repeats.begin(), repeats.end(), [&](std::size_t k) {
    return lines[k].text() == lines[k - 1].text();
  });
}

[[noreturn]] void refuse_repeats(std::span<const LineOfFile> lines, const StampRule& rule,
                                 const Indices& repeats) {
  const LineOfFile& line = lines[repeats.front()];
  const std::size_t before = lines[repeats.front() - 1].number();
  const std::string all = counted(repeats.size(), "line");
  if (are_rows(lines, rule, repeats)) {
    line.refuse(
        fmt::format("time stamps must rise, and this is the row of line {} again ({} repeat the "
                    "row before to the last digit); expected each row once",
                    before, all));
  }
  line.refuse(
      fmt::format("time stamps must rise, and this is that of line {}, of another pose ({} have "
                  "the stamp of the line before); expected one pose a time: the file does not say "
                  "which is right",
                  before, all));
}

// Whether order by time would mix the stretches, as it does those of several runs, or join whole
// ones with a pause between. Lines that came too late or too early go to one place, as a whole.
bool are_runs(Times times_ns, const Indices& falls) {
  Indices order(times_ns.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return times_ns[a] < times_ns[b]; });
  const auto stretch_of = [&](std::size_t k) {
    return std::upper_bound(falls.begin(), falls.end(), k) - falls.begin();
  };
  std::size_t changes = 0;
  double pause_s = 0.0;
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (stretch_of(order[k]) == stretch_of(order[k - 1])) continue;
    ++changes;
    pause_s = std::max(pause_s, step_s(times_ns[order[k - 1]], times_ns[order[k]]));
  }
  constexpr std::size_t kOfALateLine = 2;
  constexpr std::size_t kRows = 10;
  constexpr double kSteps = 10.0;
  const bool is_mixed = changes > 2 * kOfALateLine * falls.size();
  const bool are_whole = changes == falls.size() && times_ns.size() > kRows * falls.size();
  return is_mixed || (are_whole && pause_s > kSteps * mean_step_s(times_ns));
}

[[noreturn]] void refuse_falls(std::span<const LineOfFile> lines, Times times_ns,
                               const StampRule& rule, const Indices& falls) {
  constexpr std::size_t kShown = 8;
  const LineOfFile& line = lines[falls.front()];
  const std::string back =
      fmt::format("time goes back from {} to {}", in_quotes(stamp_text(lines[falls.front() - 1])),
                  in_quotes(stamp_text(line)));
  if (are_runs(times_ns, falls)) {
    std::string begins;
    for (std::size_t i = 0; i < std::min(falls.size(), kShown); ++i) {
      begins += ' ' + std::to_string(lines[falls[i]].number());
    }
    if (falls.size() > kShown) begins += " …";
    line.refuse(fmt::format(
        "{}: {} runs in one file, the second begins here; expected one run a file: csplit -f run- "
        "{}{} "
        "cuts it at {}",
        back, falls.size() == 1 ? "two" : std::to_string(falls.size() + 1), shell_word(line.file()),
        begins, falls.size() == 1 ? "this line" : "these lines"));
  }
  line.refuse(fmt::format("{} ({} in all): the lines are not in the order of time; {}", back,
                          counted(falls.size(), "time"),
                          rule.sort.empty() ? "expected rising time stamps"
                                            : rule.sort + " orders them and keeps all"));
}

}  // namespace

void require_rising(std::span<const LineOfFile> lines, std::span<const std::int64_t> times_ns,
                    const StampRule& rule) {
  const Indices repeats = repeats_in(times_ns);
  const Indices falls = falls_in(times_ns);
  if (!repeats.empty() && !are_rows(lines, rule, repeats)) {
    refuse_few_digits(lines, times_ns, rule, repeats);
  }
  if (!falls.empty()) refuse_falls(lines, times_ns, rule, falls);
  if (!repeats.empty()) refuse_repeats(lines, rule, repeats);
}

}  // namespace fathom
