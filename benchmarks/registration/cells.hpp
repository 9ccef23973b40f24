#pragma once

#include <optional>
#include <vector>

#include "contenders.hpp"
#include "floors.hpp"

namespace fathom::benchmarks {

/// An answer held against the truth.
struct Verdict {
  bool accepted = false;
  bool right = false;  ///< accepted, and within the wrong_limits
  double translation_m = 0.0;
  double translation_px = 0.0;  ///< in pixels on the floor of the lower picture
  double heading_rad = 0.0;
  std::optional<double> nis;  ///< ν' C⁻¹ ν of ν = z − truth, where there is a covariance
  double match_ms = 0.0;
  double solve_ms = 0.0;
};

struct PairRecord {
  std::size_t bucket = 0;  ///< index into those of the settings
  double overlap = 0.0;
  bool is_time_split = false;
  Verdict ours;
  std::optional<Verdict> opencv;
};

/// All pairs of a floor under a condition.
struct Cell {
  std::string floor;
  std::string condition;
  std::vector<PairRecord> pairs;
  std::vector<double> extraction_ms;  ///< of every picture
};

std::vector<test::Bucket> buckets_of(const Settings& settings);

/// The poses of the pairs are the same under every condition; the rest is drawn anew. Each of the
/// `pairs_per_cell` rounds takes one picture and a partner in every bucket, so pairs within a
/// bucket are independent, those of one round share a picture.
Cell run_cell(const Floor& floor, const test::Condition& condition, const Settings& settings);

}  // namespace fathom::benchmarks
