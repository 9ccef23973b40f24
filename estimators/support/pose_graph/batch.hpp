#pragma once

#include <optional>
#include <span>
#include <vector>

#include "estimators/support/pose_graph/solver.hpp"

namespace fathom::pose_graph {

/// Where a batch solve starts.
enum class Start {
  automatic,  ///< what gets there, see solve_batch
  given,      ///< the estimate that it is given
  lago,       ///< headings by linear least squares, rounded along the given estimate
  chordal,    ///< headings by chordal relaxation
  lifted      ///< headings by lifted_headings
};

/// Headings of LAGO, or chordal ones, are trusted if every edge keeps its turn to this, before the
/// positions are computed and after: a wrong multiple of 2π leaves more on the edges of some loop.
/// On the sets of docs/estimators/sparse_gauss_newton.md it is 0.13 rad at most where the rounding
/// is right, 0.7 rad and more where it is wrong.
inline constexpr double kTrustedTurnRad = 0.5;
/// The same of a chain as a whole, over whose steps a wrong multiple may spread. Chosen on drawn
/// streets of 1000 and 3000 keyframes, 240 of them, with few to many loops and 0.05 to 0.2 rad a
/// step: 0.5, 0.75 and 1 end at the least F in 234, 1.5 and none in 232.
inline constexpr double kTrustedChainRad = 1.0;
/// Where the positions turn no heading of LAGO by more, its start is so near the minimum that
/// Newton's steps serve from the first on. Chosen on seeds 1 to 5 of benchmarks/graph_shapes.hpp.
/// Of 48 graphs with seeds 11 to 18 it saves a linearisation in 18 and costs none.
inline constexpr double kNearRad = 0.03;
/// Least squares in the headings are solved again until none turns by more, so often at most. The
/// joint solve that follows corrects what is left.
inline constexpr double kHeadingsSettledRad = 1e-3;
inline constexpr int kHeadingSolves = 10;

/// Minimises F over a whole graph. `nodes` is the given estimate, dead reckoning or a guess, and
/// becomes the result; on failure it stays as it was.
///
/// `automatic` begins, in a graph of long chains, with the minimum of the graph without them
/// (ChainGraph), and else with LAGO, which costs little. Where that leaves every edge's heading
/// close to what it measured, no multiple of 2π was rounded wrongly, and its minimum is taken. Else
/// that of `chordal` is, where the same holds, else that of `lifted`; if that is none, the least F
/// of these and of the given start.
SolveResult solve_batch(std::span<const Edge> edges, std::vector<Node>& nodes, Start start,
                        const SolveLimits& limits, Workers* workers = nullptr);

}  // namespace fathom::pose_graph
