#pragma once

#include <string>

#include "fathom/measurements/g2o.hpp"

namespace fathom::test {

/// The text as that of a file graph.g2o.
inline MeasurementLog parse(const std::string& text, const GraphOptions& options = {}) {
  return parse_g2o(text, "graph.g2o", options);
}

}  // namespace fathom::test
