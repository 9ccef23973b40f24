#pragma once

#include <optional>
#include <vector>

#include "cells.hpp"
#include "fathom/evaluation/interval.hpp"

namespace fathom::benchmarks {

/// The value below which a share of the values lies, between two of them linear; NaN of none.
double percentile(std::vector<double> values, double share);

struct Share {
  std::size_t successes = 0;
  std::size_t count = 0;
};

struct MedianAnd95 {
  double median = 0.0;
  double p95 = 0.0;
};

/// Of the normalised innovations squared of right acceptances, 3 degrees of freedom each.
struct NisSummary {
  std::size_t count = 0;
  double mean = 0.0;
  Interval expected;             ///< 95 % of the means of as many χ² variables
  double share_beyond_95 = 0.0;  ///< of those above the 95 % quantile; 0.05 is expected
};

/// One contender in one cell.
struct ContenderSummary {
  Share recall;  ///< right acceptances of all pairs
  std::vector<Share> recall_by_bucket;
  Share wrong;  ///< wrong motions of all acceptances
  // Of right acceptances.
  MedianAnd95 translation_m;
  MedianAnd95 translation_px;
  MedianAnd95 heading_rad;
  std::optional<NisSummary> nis;
  double match_ms = 0.0;  ///< medians
  double solve_ms = 0.0;
};

struct CellSummary {
  std::string floor;
  std::string condition;
  double extraction_ms = 0.0;
  ContenderSummary ours;
  std::optional<ContenderSummary> opencv;
};

CellSummary summarise(const Cell& cell, std::size_t buckets);

}  // namespace fathom::benchmarks
