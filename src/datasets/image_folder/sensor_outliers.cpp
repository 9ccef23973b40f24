#include "sensor_outliers.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "fathom/datasets/series_outliers.hpp"

namespace fathom {
namespace {

constexpr double kAllowedTilt_rad = 0.2;
// Of a tilt, by its own standard deviations.
constexpr double kAllowedSigmas = 10.0;

}  // namespace

std::optional<std::size_t> first_outlier(const std::vector<bool>& plausible) {
  const auto found = std::find(plausible.begin(), plausible.end(), false);
  if (found == plausible.end()) return std::nullopt;
  return static_cast<std::size_t>(found - plausible.begin());
}

std::string outlier_remark(const std::string& sensor, const std::vector<bool>& plausible,
                           std::size_t line_of_first, const std::string& detail, bool are_kept) {
  return fmt::format(
      "{}: {} of {} readings {} (first: line {}, {}); 'outliers: keep' in its sensor.yaml keeps "
      "them",
      sensor, std::count(plausible.begin(), plausible.end(), false), plausible.size(),
      are_kept ? "contradict their neighbours" : "left out", line_of_first, detail);
}

std::vector<bool> plausible_tilts(const TimeLine& times, const std::vector<MeasuredTilt>& tilts) {
  std::vector<std::int64_t> times_ns;
  for (std::size_t i = 0; i < tilts.size(); ++i) times_ns.push_back(times.at(i));
  return kept_readings(
      {times_ns,
       [&tilts](std::size_t i, std::size_t j) {
         const Tilt& a = tilts[i].tilt;
         const Tilt& b = tilts[j].tilt;
         return std::max(std::abs(a.roll_rad - b.roll_rad), std::abs(a.pitch_rad - b.pitch_rad));
       },
       [&tilts](std::size_t i, std::size_t j) {
         return std::max(kAllowedTilt_rad,
                         kAllowedSigmas * std::hypot(tilts[i].sigma_rad, tilts[j].sigma_rad));
       }});
}

Filling filling(const TimeLine& times, const KeptReadings& kept, const Bracket& in_all,
                std::int64_t time_ns) {
  if (kept[in_all.before] && kept[in_all.after]) return {in_all, 0.0};
  const auto before = kept.before(in_all.before);
  const auto after = kept.after(in_all.after);
  if (!before || !after) {
    const std::size_t nearest = before ? *before : after.value();
    const auto intervals =
        static_cast<double>(before ? in_all.after - nearest : nearest - in_all.before);
    return {{nearest, nearest, 0.0}, std::sqrt(1.0 + 2.0 * intervals)};
  }
  const auto since_ns = static_cast<double>(time_ns - times.at(*before));
  const auto gap_ns = static_cast<double>(times.at(*after) - times.at(*before));
  return {{*before, *after, since_ns / gap_ns},
          std::sqrt(1.0 + static_cast<double>(*after - *before))};
}

double spread_around(const Bracket& bracket, const KeptReadings& kept,
                     const std::function<double(std::size_t)>& value) {
  constexpr std::size_t kEither = 2;
  std::vector<double> near;
  for (std::size_t nth = 0; nth < kEither; ++nth) {
    if (const auto i = kept.before(bracket.before, nth)) near.push_back(value(*i));
  }
  const std::size_t first = std::max(bracket.after, bracket.before + 1);
  for (std::size_t nth = 0; nth < kEither; ++nth) {
    if (const auto i = kept.after(first, nth)) near.push_back(value(*i));
  }
  double mean = 0.0;
  for (const double one : near) mean += one / static_cast<double>(near.size());
  double squares = 0.0;
  for (const double one : near) squares += (one - mean) * (one - mean);
  return near.size() < 2 ? 0.0 : std::sqrt(squares / static_cast<double>(near.size() - 1));
}

}  // namespace fathom
