// sparse_gauss_newton on several threads: the bits of one, over starts, losses and modes.

#include <array>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "estimators/support/pose_graph/batch.hpp"
#include "tests/estimators/graph_parts.hpp"
#include "tests/estimators/logs.hpp"

namespace fathom {
namespace {

using pose_graph::Start;

constexpr std::array<int, 3> kThreads{2, 3, 7};

// Tracks there and back, one of `every` keyframes seen from the track before: separators as wide as
// a track. `false_every`: so many loops, one is wrong.
MeasurementLog survey(std::size_t tracks, std::size_t along_track, std::size_t false_every = 0,
                      std::size_t every = 3) {
  const auto truth = [along_track](std::size_t k) {
    const std::size_t track = k / along_track;
    const std::size_t along = k % along_track;
    const bool back = track % 2 == 1;
    return Pose{static_cast<double>(back ? along_track - 1 - along : along),
                2.0 * static_cast<double>(track), back ? M_PI : 0.0};
  };
  RandomStream random(3, "survey");
  const auto measured = [&](std::size_t from, std::size_t to, const Pose& error) {
    const Pose motion = between(truth(from), truth(to));
    return RelativePose::from_covariance(
        from, to, compose(test::perturbed(motion, 0.02, 0.005, random), error),
        test::full_covariance(0.02, 0.005));
  };
  MeasurementLog log(truth(0));
  std::size_t loops = 0;
  for (std::size_t k = 1; k < tracks * along_track; ++k) {
    log.add_keyframe(measured(k - 1, k, {}));
    if (k < along_track || k % every != 0) continue;
    const bool is_false = false_every > 0 && ++loops % false_every == 0;
    const Pose error = is_false ? Pose{3.0, -2.0, 1.0} : Pose{};
    log.add_registration(measured(k - 2 * (k % along_track) - 1, k, error));
  }
  return log;
}

std::vector<pose_graph::Node> solved(const test::GraphParts& parts, Start start, int threads,
                                     pose_graph::SolveResult& result) {
  Workers workers(threads);
  std::vector<pose_graph::Node> nodes = parts.nodes;
  result = pose_graph::solve_batch(parts.edges, nodes, start, {}, threads > 1 ? &workers : nullptr);
  return nodes;
}

bool same_bits(const std::vector<pose_graph::Node>& a, const std::vector<pose_graph::Node>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

void expect_bits_of_one_thread(const test::GraphParts& parts, Start start) {
  pose_graph::SolveResult alone;
  const auto nodes = solved(parts, start, 1, alone);
  EXPECT_EQ(alone.outcome, Outcome::converged);
  for (const int threads : kThreads) {
    pose_graph::SolveResult shared;
    EXPECT_TRUE(same_bits(solved(parts, start, threads, shared), nodes)) << threads;
    EXPECT_EQ(shared.iterations, alone.iterations);
    EXPECT_EQ(shared.cost, alone.cost);
    EXPECT_EQ(shared.gradient_norm, alone.gradient_norm);
    EXPECT_EQ(shared.is_local_minimum, alone.is_local_minimum);
  }
}

// Of what is left without chains, which is what is factored.
std::size_t blocks_left(const test::GraphParts& parts) {
  const pose_graph::ChainGraph graph(parts.edges, parts.nodes);
  EXPECT_TRUE(graph.has_chains());
  return pose_graph::analyse_graph(graph.edges(), static_cast<int>(graph.nodes().size()))
      .panel_blocks;
}

TEST(SharedSolve, IsThatOfOneThreadFromEachStart) {
  const test::GraphParts parts = test::parts_of(survey(60, 80));
  ASSERT_GT(blocks_left(parts), sparse::kLeastSharedBlocks);
  for (const Start start :
       {Start::automatic, Start::given, Start::lago, Start::chordal, Start::lifted}) {
    expect_bits_of_one_thread(parts, start);
  }
}

// Few long tracks: narrow separators, and branches that are long.
TEST(SharedSolve, IsThatOfOneThreadOnOtherShapes) {
  const test::GraphParts parts = test::parts_of(survey(3, 8000));
  ASSERT_GT(blocks_left(parts), sparse::kLeastSharedBlocks);
  expect_bits_of_one_thread(parts, Start::automatic);
}

// Few loops: it is the elimination of the chains that is shared.
TEST(SharedSolve, EliminatesChainsAsOneThreadDoes) {
  const test::GraphParts parts = test::parts_of(survey(10, 2000, 0, 40));
  const pose_graph::ChainGraph graph(parts.edges, parts.nodes);
  ASSERT_TRUE(graph.has_chains());
  ASSERT_GT(graph.chains().size(), 600U);
  ASSERT_GT(parts.nodes.size() - graph.nodes().size(), 10000U);
  for (const Start start : {Start::automatic, Start::lago, Start::given}) {
    expect_bits_of_one_thread(parts, start);
  }
}

// Information that leaves a heading free: the factorisations fail.
TEST(SharedSolve, FailsAsOneThreadDoes) {
  test::GraphParts parts = test::parts_of(survey(60, 70));
  for (std::size_t e = 0; e < parts.edges.size(); e += 2) parts.edges[e].W = {};
  pose_graph::SolveResult alone;
  const auto nodes = solved(parts, Start::automatic, 1, alone);
  for (const int threads : kThreads) {
    pose_graph::SolveResult shared;
    EXPECT_TRUE(same_bits(solved(parts, Start::automatic, threads, shared), nodes)) << threads;
    EXPECT_EQ(shared.outcome, alone.outcome);
    EXPECT_EQ(shared.iterations, alone.iterations);
  }
}

std::vector<Pose> estimate_of(const MeasurementLog& log, SolveMode mode,
                              std::vector<std::pair<std::string, std::string>> values,
                              int threads) {
  values.emplace_back("threads", std::to_string(threads));
  const auto estimator = builtin_estimators()
                             .find("sparse_gauss_newton")
                             .create({log.origin(), mode}, test::values(values));
  for (std::size_t k = 1; k < log.size(); ++k) {
    estimator->add_keyframe(log.arrival(k).step);
    if (log.arrival(k).registrations.empty()) continue;
    estimator->update({log.arrival(k).registrations});
  }
  estimator->finish({});
  return poses_of(*estimator);
}

void expect_estimate_of_one_thread(const MeasurementLog& log, SolveMode mode,
                                   const std::vector<std::pair<std::string, std::string>>& values) {
  const std::vector<Pose> alone = estimate_of(log, mode, values, 1);
  for (const int threads : kThreads) {
    const std::vector<Pose> shared = estimate_of(log, mode, values, threads);
    ASSERT_EQ(shared.size(), alone.size());
    EXPECT_EQ(std::memcmp(shared.data(), alone.data(), alone.size() * sizeof(Pose)), 0)
        << threads << " threads";
  }
}

TEST(SharedSolve, IsThatOfOneThreadWithALoss) {
  const MeasurementLog log = survey(60, 70, 20);
  for (const std::string loss : {"huber", "geman_mcclure", "truncated"}) {
    SCOPED_TRACE(loss);
    expect_estimate_of_one_thread(log, SolveMode::batch, {{"loss", loss}});
  }
}

TEST(SharedSolve, IsThatOfOneThreadKeyframeByKeyframe) {
  const MeasurementLog few = [] {
    const MeasurementLog all = survey(2, 12000);
    MeasurementLog log(all.origin());
    for (std::size_t k = 1; k < all.size(); ++k) {
      log.add_keyframe(all.arrival(k).step);
      if (k % 3000 != 0) continue;
      for (const RelativePose& z : all.arrival(k).registrations) log.add_registration(z);
    }
    return log;
  }();
  ASSERT_GT(test::parts_of(few).analysed().panel_blocks, sparse::kLeastSharedBlocks);
  expect_estimate_of_one_thread(few, SolveMode::incremental, {});
}

// Where there is nothing to share.
TEST(SharedSolve, TakesGraphsOfAnySize) {
  for (const std::size_t keyframes : {1u, 2u, 30u}) {
    const MeasurementLog log = test::circle_of(keyframes);
    expect_estimate_of_one_thread(log, SolveMode::batch, {});
    expect_estimate_of_one_thread(log, SolveMode::incremental, {});
  }
}

}  // namespace
}  // namespace fathom
