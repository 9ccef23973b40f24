#pragma once

#include <string>
#include <vector>

#include "negatives.hpp"
#include "speed.hpp"
#include "summary.hpp"

namespace fathom::benchmarks {

struct Results {
  Settings settings;
  std::vector<CellSummary> cells;
  std::vector<Negatives> negatives;
  std::vector<std::pair<std::string, Speed>> speeds;  ///< by floor
};

/// Tables of one floor's cells.
std::string markdown(const std::vector<CellSummary>& cells, const Settings& settings);
std::string markdown(const std::vector<Negatives>& negatives, const Settings& settings);
std::string markdown(const std::vector<std::pair<std::string, Speed>>& speeds);

/// All of it, numbers in full.
std::string json_text(const Results& results);

}  // namespace fathom::benchmarks
