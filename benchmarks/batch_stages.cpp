// Where a batch solve of sparse_gauss_newton spends its time: each stage by itself, on the calling
// thread, for graphs of several shapes.
//
//     batch_benchmark --benchmark_filter=stages

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "benchmarks/back_ends/survey.hpp"
#include "benchmarks/graph_shapes.hpp"
#include "estimators/support/pose_graph/batch.hpp"
#include "estimators/support/pose_graph/chain_turns.hpp"
#include "estimators/support/pose_graph/headings.hpp"
#include "estimators/support/sparse/tree_cut.hpp"
#include "fathom/estimators/builtin.hpp"

namespace {

using fathom::MeasurementLog;
using namespace fathom::pose_graph;
using Clock = std::chrono::steady_clock;

// Of two blocks.
constexpr double kMultiplyAdds = 27.0;

struct Shape {
  const char* name;
  std::function<MeasurementLog()> make;
};

// Seeds that set no constant.
const std::vector<Shape>& shapes() {
  namespace b = fathom::benchmarks;
  static const std::vector<Shape> all{{"chain", [] { return b::drive(4541, 0, 11); }},
                                      {"drive", [] { return b::drive(4541, 137, 11); }},
                                      {"short_drive", [] { return b::drive(1591, 2, 12); }},
                                      {"office", [] { return b::office(1316, 13); }},
                                      {"circuit", [] { return b::circuit(3000, 14); }},
                                      {"survey", [] { return b::parallel_tracks(10000, 3333); }},
                                      {"streets", [] { return b::dense_streets(10000, 15); }}};
  return all;
}

class Stages {
 public:
  explicit Stages(benchmark::State& state) : state_(state) {}

  template <class Work>
  void time(const char* name, const Work& work) {
    const auto start = Clock::now();
    work();
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    auto& counter = state_.counters[name];
    counter.value += 1e3 * seconds;
    counter.flags = benchmark::Counter::kAvgIterations;
  }

 private:
  benchmark::State& state_;
};

// Multiply-adds a millisecond of this machine: of one dense matrix of 300 unknowns, in the cache.
double dense_rate() {
  constexpr int kNodes = 100;
  std::vector<fathom::sparse::Link> links;
  for (int a = 0; a < kNodes; ++a) {
    for (int b = 0; b < a; ++b) links.push_back({a, b});
  }
  const fathom::sparse::Symbolic symbolic =
      fathom::sparse::analyse(fathom::sparse::adjacency_of(kNodes, links));
  fathom::sparse::BlockCholesky<3> factor(symbolic);
  double least_ms = 1e9;
  for (int i = 0; i < 50; ++i) {
    factor.clear();
    for (int k = 0; k < kNodes; ++k) {
      const fathom::sparse::BlockPlace place = factor.place(k, k);
      for (int a = 0; a < 3; ++a) {
        factor.data()[place.offset + static_cast<std::size_t>(a * (place.stride + 1))] = 1.0;
      }
    }
    const auto start = Clock::now();
    benchmark::DoNotOptimize(factor.factorise());
    least_ms =
        std::min(least_ms, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  return kMultiplyAdds * multiplications_of(symbolic) / least_ms;
}

template <class Equations>
void time_step(Equations& equations, const std::vector<Node>& given, Stages& timed) {
  timed.time("first linearisation", [&] { equations.linearise(given, Hessian::gauss_newton); });
  timed.time("linearise", [&] { equations.linearise(given, Hessian::gauss_newton); });
  timed.time("factorise", [&] { benchmark::DoNotOptimize(equations.factorise()); });
  timed.time("substitute", [&] { equations.solve_step(); });
  std::vector<Node> moved;
  timed.time("move", [&] { equations.move(given, moved); });
  timed.time("check", [&] { benchmark::DoNotOptimize(equations.differentiate(given)); });
}

// The stages of `finish`, each once.
void time_stages(const std::vector<Edge>& edges, const std::vector<Node>& given, Stages& timed) {
  std::vector<double> theta;
  for (const Node& node : given) theta.push_back(node.theta);
  std::optional<ChainGraph> chains;
  bool is_start = false;
  timed.time("chains", [&] {
    chains.emplace(edges, given);
    is_start = chains->measure();
  });
  if (is_start) {
    timed.time("expand", [&] { benchmark::DoNotOptimize(chains->expanded(chains->nodes())); });
  }
  const bool has_chains = chains->has_chains();
  const std::span<const Edge> left = has_chains ? chains->edges() : std::span<const Edge>(edges);
  const std::size_t left_nodes = has_chains ? chains->nodes().size() : given.size();
  fathom::sparse::Symbolic symbolic;
  timed.time("analysis", [&] { symbolic = analyse_graph(left, static_cast<int>(left_nodes)); });
  timed.time("headings", [&] {
    std::optional<ChainTurns> turns;
    if (has_chains) turns.emplace(*chains);
    HeadingProblem headings(symbolic, turns ? turns->edges() : left);
    benchmark::DoNotOptimize(turns ? turns->solve(headings, theta) : headings.solve(theta));
  });
  std::optional<NormalEquations> of_left;
  std::optional<ChainEquations> of_chains;
  timed.time("memory", [&] {
    of_left.emplace(symbolic, left);
    if (has_chains) of_chains.emplace(*chains, *of_left);
  });
  if (has_chains) {
    time_step(*of_chains, given, timed);
  } else {
    time_step(*of_left, given, timed);
  }
}

// Stages of one solve, and the whole: `finish` is all but the hand-over. `clear` is the bandwidth
// of this machine over the memory of the factor, `dense` the time of the factorisation's
// multiply-adds in a dense matrix.
void stages(benchmark::State& state, const Shape& shape) {
  const MeasurementLog log = shape.make();
  std::vector<Edge> edges;
  std::size_t loops = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    edges.push_back(make_edge(log.arrival(k).step));
    for (const auto& z : log.arrival(k).registrations) edges.push_back(make_edge(z));
    loops += log.arrival(k).registrations.size();
  }
  const std::vector<Node> given = nodes_of(log.odometry());
  Stages timed(state);
  int iterations = 0;
  const fathom::sparse::Symbolic pattern = analyse_graph(edges, static_cast<int>(given.size()));
  fathom::sparse::BlockCholesky<3> factor(pattern);
  static const double rate = dense_rate();
  state.counters["dense"] = kMultiplyAdds * multiplications_of(pattern) / rate;
  state.counters["10^6 multiply-adds"] = 1e-6 * kMultiplyAdds * multiplications_of(pattern);
  state.counters["factor, MB"] = 72e-6 * static_cast<double>(pattern.panel_blocks);
  for ([[maybe_unused]] auto _ : state) {
    const auto estimator = fathom::builtin_estimators()
                               .find("sparse_gauss_newton")
                               .create({log.origin(), fathom::SolveMode::batch}, {});
    const auto start = Clock::now();
    timed.time("hand over", [&] {
      for (std::size_t k = 1; k < log.size(); ++k) {
        estimator->add_keyframe(log.arrival(k).step);
        if (!log.arrival(k).registrations.empty()) {
          estimator->update({log.arrival(k).registrations});
        }
      }
    });
    timed.time("finish", [&] { iterations = estimator->finish({}).iterations; });
    state.SetIterationTime(std::chrono::duration<double>(Clock::now() - start).count());

    timed.time("clear", [&] { factor.clear(); });
    time_stages(edges, given, timed);
  }
  state.counters["keyframes"] = static_cast<double>(log.size());
  state.counters["loops"] = static_cast<double>(loops);
  state.counters["linearisations"] = iterations;
}

const bool is_registered = [] {
  for (const Shape& shape : shapes()) {
    benchmark::RegisterBenchmark(("stages/" + std::string(shape.name)).c_str(),
                                 [&shape](benchmark::State& state) { stages(state, shape); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
