#pragma once

#include <string>

#include "g2o_file.hpp"

namespace fathom {

/// Gives the edges of a graph what a file of shared errors tells of them. All that it cannot use is
/// a fault: a line of no edge, parts that do not add up to the edge's covariance, standard
/// deviations without responses and the other way round.
void read_shared(const std::string& content, G2oFile& graph, const std::string& graph_name,
                 const G2oFault& fault);

}  // namespace fathom
