#pragma once

#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>

namespace fathom::test {

/// A g2o graph of `poses` poses round a square of 25 edges, a full information matrix, with a loop
/// of the last round from every `loop_every`-th pose on.
inline std::string square_graph(std::size_t poses, std::size_t loop_every) {
  constexpr std::size_t kRound = 100;
  const std::string information = " 400 20 -5 300 10 900\n";
  std::ostringstream text;
  for (std::size_t k = 1; k < poses; ++k) {
    const double turn = k % (kRound / 4) == 0 ? 1.57079632679 : 0.0;
    // Errors that repeat, so that there is something to correct.
    const double wobble = 0.004 * std::sin(0.7 * static_cast<double>(k));
    text << "EDGE_SE2 " << k - 1 << " " << k << " " << 1.0 + wobble << " " << wobble << " "
         << turn + 0.1 * wobble << information;
    if (k >= kRound && k % loop_every == 0) {
      text << "EDGE_SE2 " << k - kRound << " " << k << " 0 0 0" << information;
    }
  }
  return text.str();
}

/// A sound graph of two poses and their odometry edge, to be spoilt.
inline const std::string kTwoPoses =
    "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n";

}  // namespace fathom::test
