#include "fathom/measurements/held_out_loops.hpp"

#include <algorithm>
#include <cassert>
#include <string>

#include "fathom/core/disjoint_sets.hpp"
#include "fathom/core/random.hpp"

namespace fathom {
namespace {

// visit(registration, its place) in order of arrival.
template <class Visit>
void for_each_registration(const MeasurementLog& log, const Visit& visit) {
  std::size_t place = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    for (const RelativePose& z : log.arrival(k).registrations) visit(z, place++);
  }
}

// The same whichever way round it is written, and whatever other pairs a log has.
bool is_drawn(const RelativePose& z, double share, std::uint64_t trial_seed) {
  const auto [first, last] = std::minmax(z.from, z.to);
  return RandomStream(trial_seed, std::to_string(first), last).uniform() < share;
}

// By steps that were measured and registrations that stay.
DisjointSets joined_without(const MeasurementLog& log, const std::vector<bool>& is_false,
                            const std::vector<bool>& is_held_out) {
  DisjointSets sets(log.size());
  for (std::size_t k = 1; k < log.size(); ++k) {
    if (!log.arrival(k).step.is_hole) sets.join(k - 1, k);
  }
  for_each_registration(log, [&](const RelativePose& z, std::size_t place) {
    const bool is_known_false = !is_false.empty() && is_false[place];
    if (!is_held_out[place] && !is_known_false) sets.join(z.from, z.to);
  });
  return sets;
}

// What lies behind a hole is held by registrations alone: the first of those that were drawn and
// without which it would come loose stays.
void keep_joined(const MeasurementLog& log, const std::vector<bool>& is_false,
                 std::vector<bool>& is_held_out) {
  if (log.hole_count() == 0) return;
  DisjointSets sets = joined_without(log, is_false, is_held_out);
  for_each_registration(log, [&](const RelativePose& z, std::size_t place) {
    if (!is_held_out[place] || sets.root(z.from) == sets.root(z.to)) return;
    sets.join(z.from, z.to);
    is_held_out[place] = false;
  });
}

}  // namespace

std::vector<bool> draw_held_out(const MeasurementLog& log, const std::vector<bool>& is_false,
                                double share, std::uint64_t seed, std::uint64_t trial) {
  assert(is_false.empty() || is_false.size() == log.registration_count());
  const std::uint64_t trial_seed = stream_seed(seed, "held_out_loops", trial);
  std::vector<bool> is_held_out;
  for_each_registration(log, [&](const RelativePose& z, std::size_t place) {
    const bool is_step = std::max(z.from, z.to) - std::min(z.from, z.to) == 1;
    const bool is_known_false = !is_false.empty() && is_false[place];
    is_held_out.push_back(!is_step && !is_known_false && is_drawn(z, share, trial_seed));
  });
  keep_joined(log, is_false, is_held_out);
  return is_held_out;
}

MeasurementLog log_without(const MeasurementLog& log, const std::vector<bool>& is_held_out) {
  assert(is_held_out.size() == log.registration_count());
  MeasurementLog rest(log.start());
  std::size_t place = 0;
  for (std::size_t k = 0; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    if (k > 0) rest.add_keyframe(arrival.step);
    for (const AbsolutePose& z : arrival.absolute) rest.add_absolute(z);
    for (const RelativePose& z : arrival.registrations) {
      if (!is_held_out[place++]) rest.add_registration(z);
    }
  }
  rest.ids = log.ids;
  rest.guess = log.guess;
  rest.self_edges = log.self_edges;
  return rest;
}

std::vector<RelativePose> held_out_of(const MeasurementLog& log,
                                      const std::vector<bool>& is_held_out) {
  std::vector<RelativePose> loops;
  for_each_registration(log, [&](const RelativePose& z, std::size_t place) {
    if (is_held_out[place]) loops.push_back(z);
  });
  return loops;
}

}  // namespace fathom
