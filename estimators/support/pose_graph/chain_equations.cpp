#include "estimators/support/pose_graph/chain_equations.hpp"

#include <algorithm>
#include <cmath>

#include "estimators/support/pose_graph/chain_elimination.hpp"

namespace fathom::pose_graph {
namespace {

// Chains that a thread takes at once.
constexpr std::size_t kChainsAtOnce = 256;
// Fewer keyframes inside of chains are half a millisecond of work.
constexpr std::size_t kLeastSharedKeyframes = 10000;

struct ChainParts {
  const ChainGraph& graph;
  std::span<const ChainGraph::Chain> chains;
  const std::size_t* begins;
  EliminatedKeyframe* inside;
  PairTerms* terms;
  ChainSums* sums;
  const Node* nodes;
  double damping = 0.0;
};

template <class OfChain>
struct ChainTask {
  const ChainParts& parts;
  std::size_t begin;
  std::size_t end;

  FATHOM_INLINE bool run() const {
    for (std::size_t i = begin; i < end; ++i) {
      const ChainGraph::Chain& chain = parts.chains[i];
      OfChain{{parts.graph, chain, parts.nodes + chain.begin, parts.inside + parts.begins[i],
               parts.terms[i], parts.sums[i], parts.damping}}
          .run();
    }
    return true;
  }
};

template <class OfChain>
void for_chains(Workers* workers, const ChainParts& parts) {
  for_ranges(workers, parts.chains.size(), kChainsAtOnce, [&](std::size_t begin, std::size_t end) {
    ChainTask<OfChain> task{parts, begin, end};
    sparse::run_for_processor(task);
  });
}

struct BackSubstitutionTask {
  std::span<const ChainVector> steps;  ///< of the ends, by chain and one more
  const std::size_t* begins;
  EliminatedKeyframe* inside;
  std::size_t begin;
  std::size_t end;

  FATHOM_INLINE bool run() const {
    for (std::size_t i = begin; i < end; ++i) {
      substitute_back({inside + begins[i], begins[i + 1] - begins[i]}, steps[i], steps[i + 1]);
    }
    return true;
  }
};

std::span<const ChainGraph::Chain> closed(std::span<const ChainGraph::Chain> chains) {
  return chains.first(chains.size() - (chains.back().is_open ? 1 : 0));
}

std::vector<std::size_t> begins_of(std::span<const ChainGraph::Chain> chains) {
  std::vector<std::size_t> begins{0};
  begins.reserve(chains.size() + 1);
  for (const ChainGraph::Chain& chain : chains)
    begins.push_back(begins.back() + at(chain.count - 1));
  return begins;
}

}  // namespace

ChainEquations::ChainEquations(const ChainGraph& chains, NormalEquations& left, Workers* workers)
    : graph_(chains),
      left_(left),
      chains_(closed(chains.chains())),
      begins_(begins_of(chains_)),
      workers_(begins_.back() < kLeastSharedKeyframes ? nullptr : workers),
      memory_(
          std::max<std::size_t>(begins_.back(), 1) * sizeof(EliminatedKeyframe) / sizeof(double),
          workers_),
      inside_(reinterpret_cast<EliminatedKeyframe*>(memory_.data())),
      terms_(chains_.size()),
      sums_(chains_.size()) {}

std::span<const EliminatedKeyframe> ChainEquations::inside(std::size_t chain) const {
  return {inside_ + begins_[chain], begins_[chain + 1] - begins_[chain]};
}

std::span<const Node> ChainEquations::ends(std::span<const Node> nodes) {
  at_ends_.clear();
  for (const ChainGraph::Chain& chain : graph_.chains()) at_ends_.push_back(nodes[at(chain.begin)]);
  if (at_ends_.size() < graph_.nodes().size()) at_ends_.push_back(nodes.back());
  return at_ends_;
}

double ChainEquations::decrease() const {
  double decrease = 0.0;
  for (const ChainSums& sums : sums_) decrease += sums.decrease;
  return decrease;
}

void ChainEquations::eliminate(std::span<const Node> nodes, Hessian hessian, double damping) {
  const ChainParts parts{graph_,        chains_,      begins_.data(), inside_,
                         terms_.data(), sums_.data(), nodes.data(),   damping};
  switch (hessian) {
    case Hessian::gauss_newton:
      for_chains<ChainElimination<Hessian::gauss_newton>>(workers_, parts);
      break;
    case Hessian::measured:
      for_chains<ChainElimination<Hessian::measured>>(workers_, parts);
      break;
    case Hessian::exact:
      for_chains<ChainElimination<Hessian::exact>>(workers_, parts);
      break;
    case Hessian::positions:
      for_chains<ChainElimination<Hessian::positions>>(workers_, parts);
      break;
  }
  decrease_ = decrease();
  negative_pivots_ = 0;
  are_sound_ = true;
  for (const ChainSums& sums : sums_) {
    negative_pivots_ += sums.negative_pivots;
    are_sound_ = are_sound_ && sums.is_sound;
  }
}

double ChainEquations::linearise(std::span<const Node> nodes, Hessian hessian, double damping) {
  eliminate(nodes, hessian, damping);
  return left_.linearise(ends(nodes), hessian, damping, terms_);
}

double ChainEquations::differentiate(std::span<const Node> nodes) {
  const ChainParts parts{graph_,        chains_,      begins_.data(), inside_,
                         terms_.data(), sums_.data(), nodes.data()};
  for_chains<ChainDifferentiation>(workers_, parts);
  decrease_ = decrease();
  return left_.differentiate(ends(nodes), terms_);
}

void ChainEquations::solve_step() {
  substitute_back_from(left_.solve_step());
}

std::optional<double> ChainEquations::solve_near(std::span<const Node> nodes, int most_iterations) {
  eliminate(nodes, Hessian::gauss_newton, 0.0);
  if (!are_sound_ || negative_pivots_ > 0) return {};
  const std::optional<double> cost = left_.solve_near(ends(nodes), most_iterations, terms_);
  if (cost) substitute_back_from(left_.step());
  return cost;
}

// A chain's begin is the end of the one before it.
void ChainEquations::substitute_back_from(const std::vector<double>& step) {
  const std::vector<int>& position = left_.factor().symbolic().position;
  end_steps_.assign(1, ChainVector{});
  for (const int p : position) {
    const double* d = step.data() + 3 * at(p);
    end_steps_.push_back({d[0], d[1], d[2]});
  }
  for_ranges(workers_, chains_.size(), kChainsAtOnce, [&](std::size_t begin, std::size_t end) {
    BackSubstitutionTask task{end_steps_, begins_.data(), inside_, begin, end};
    sparse::run_for_processor(task);
  });
}

double ChainEquations::gradient_norm() const {
  std::vector<double> gradient = left_.gradient();
  const sparse::Symbolic& symbolic = left_.factor().symbolic();
  const auto add = [&](int node, const ChainVector& before, const ChainVector& after) {
    const int position = position_of(symbolic, node);
    for (std::size_t a = 0; position >= 0 && a < 3; ++a) {
      gradient[3 * at(position) + a] += before[a] - after[a];
    }
  };
  double largest = 0.0;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    add(static_cast<int>(i), sums_[i].g_from, terms_[i].g_from);
    add(static_cast<int>(i) + 1, sums_[i].g_to, terms_[i].g_to);
    largest = std::max(largest, sums_[i].gradient_norm);
  }
  for (const double g : gradient) largest = std::max(largest, std::abs(g));
  return 2.0 * largest;
}

void ChainEquations::move(std::span<const Node> from, std::vector<Node>& to) const {
  to.resize(from.size());
  to[0] = from[0];
  for_ranges(workers_, chains_.size(), kChainsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::size_t k = at(chains_[i].begin);
      const auto move_next = [&](double x, double y, double theta) {
        ++k;
        to[k] = moved(from[k], x, y, theta);
      };
      for (const EliminatedKeyframe& x : inside(i)) move_next(x.E[0][3], x.E[1][3], x.E[2][3]);
      move_next(end_steps_[i + 1][0], end_steps_[i + 1][1], end_steps_[i + 1][2]);
    }
  });
  graph_.follow_open_chain(to);
}

bool ChainEquations::follow_headings(std::vector<Node>& nodes) {
  linearise(nodes, Hessian::positions);
  if (!factorise(sparse::Inertia::positive)) return false;
  solve_step();
  move(nodes, nodes);
  return true;
}

bool ChainEquations::step_is_small(std::span<const Node> nodes, double tolerance) const {
  double step = 0.0;
  for (const ChainVector& d : end_steps_) step += d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  for (std::size_t i = 0; i < begins_.back(); ++i) {
    for (const auto& row : inside_[i].E) step += row[3] * row[3];
  }
  const ChainGraph::Chain& last = graph_.chains().back();
  const std::size_t moved = last.is_open ? at(last.begin) + 1 : nodes.size();
  return is_small(step, nodes.first(moved), tolerance);
}

}  // namespace fathom::pose_graph
