#include <vector>

#include "fathom/core/disjoint_sets.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/connected_guess.hpp"
#include "fathom/measurements/measurement_log.hpp"
#include "rigid_rank.hpp"

namespace fathom {
namespace {

// A heading that no axis of a measurement is parallel to by chance.
constexpr Pose kAnyTurn{0.0, 0.0, 0.7};

double rows_of_log(const MeasurementLog& log) {
  double rows = 3.0 * static_cast<double>(log.edges().size());
  if (!log.start().is_free && !log.start().is_fixed()) rows += 3.0;
  for (std::size_t k = 0; k < log.size(); ++k) {
    for (const AbsolutePose& z : log.arrival(k).absolute) rows += rank_of(z.information);
  }
  return rows;
}

}  // namespace

// Edges make rigid sets of keyframes: each but the first of its set takes three, and the set as one
// what the start or absolute measurements say of it.
double determined_unknowns(const MeasurementLog& log) {
  DisjointSets sets(log.size());
  for (const RelativePose& edge : log.edges()) sets.join(edge.from, edge.to);
  std::vector<std::vector<HeldPose>> held(log.size());  // by the first of the set
  const std::vector<Pose> poses = connected_guess(log);
  for (std::size_t k = 0; k < log.size(); ++k) {
    for (const AbsolutePose& z : log.arrival(k).absolute) {
      held[sets.root(k)].emplace_back(z, compose(kAnyTurn, poses[k]));
    }
  }
  double rank = 0.0;
  for (std::size_t k = 0; k < log.size(); ++k) {
    if (sets.root(k) != k) {
      rank += 3.0;
    } else if (k == 0 && !log.start().is_free) {
      rank += log.start().is_fixed() ? 0.0 : 3.0;
    } else {
      rank += rank_of_motions(held[k]);
    }
  }
  return rank;
}

double degrees_of_freedom(const MeasurementLog& log) {
  return rows_of_log(log) - determined_unknowns(log);
}

}  // namespace fathom
