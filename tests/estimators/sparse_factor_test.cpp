// The block Cholesky factorisation and the selected inverse against dense algebra.

#include <algorithm>
#include <limits>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "estimators/support/sparse/block_cholesky.hpp"
#include "estimators/support/sparse/selected_inverse.hpp"
#include "fathom/core/random.hpp"

namespace fathom::sparse {
namespace {

// A trajectory with loops: 0-1-2-…, and some further links, one of them twice.
std::vector<Link> links_of(int n, int loops, RandomStream& random) {
  std::vector<Link> links;
  for (int k = 1; k < n; ++k) links.push_back({k - 1, k});
  for (int j = 0; j < loops; ++j) {
    const int a = std::min(n - 1, static_cast<int>(random.uniform(0.0, n)));
    const int b = std::min(n - 1, static_cast<int>(random.uniform(0.0, n)));
    if (a != b) links.push_back({a, b});
  }
  links.push_back(links.back());
  return links;
}

// A random matrix on that pattern, dense and in the factor. `shift` on its diagonal makes it
// definite or not.
template <int B>
Eigen::MatrixXd fill(BlockCholesky<B>& factor, const std::vector<Link>& links, double shift,
                     RandomStream& random) {
  using Block = Eigen::Matrix<double, B, B>;
  const int n = factor.symbolic().size();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n * B, n * B);
  const auto random_block = [&] {
    return Block::NullaryExpr([&](Eigen::Index, Eigen::Index) { return random.normal(); }).eval();
  };
  for (const Link& link : links) {
    const Block block = random_block();
    A.block<B, B>(link.a * B, link.b * B) += block;
    A.block<B, B>(link.b * B, link.a * B) += block.transpose();
  }
  for (int i = 0; i < n; ++i) {
    const Block half = random_block();
    A.block<B, B>(i * B, i * B) = half + half.transpose() + shift * Block::Identity();
  }
  factor.clear();
  const std::vector<int>& position = factor.symbolic().position;
  const auto put = [&](int row, int column) {
    const BlockPlace place = factor.place(row, column);
    for (int a = 0; a < B; ++a) {
      for (int b = 0; b < B; ++b) {
        factor.data()[place.offset + static_cast<std::size_t>(a + b * place.stride)] =
            A(row * B + a, column * B + b);
      }
    }
  };
  for (int i = 0; i < n; ++i) put(i, i);
  for (const Link& link : links) {
    const auto [a, b] = link;
    const bool a_is_later =
        position[static_cast<std::size_t>(a)] > position[static_cast<std::size_t>(b)];
    put(a_is_later ? a : b, a_is_later ? b : a);
  }
  return A;
}

template <int B>
Eigen::VectorXd solve(BlockCholesky<B>& factor, const Eigen::VectorXd& right) {
  const std::vector<int>& position = factor.symbolic().position;
  Eigen::VectorXd x(right.size());
  for (std::size_t i = 0; i < position.size(); ++i) {
    x.segment<B>(position[i] * B) = right.segment<B>(static_cast<Eigen::Index>(i) * B);
  }
  factor.solve(x.data());
  Eigen::VectorXd result(right.size());
  for (std::size_t i = 0; i < position.size(); ++i) {
    result.segment<B>(static_cast<Eigen::Index>(i) * B) = x.segment<B>(position[i] * B);
  }
  return result;
}

template <int B>
void expect_dense_solution(int n, int loops, ChainElimination chains) {
  RandomStream random(static_cast<std::uint64_t>(n * 100 + loops), "factor");
  const std::vector<Link> links = links_of(n, loops, random);
  const Symbolic symbolic = analyse(adjacency_of(n, links), chains);
  BlockCholesky<B> factor(symbolic);
  const Eigen::MatrixXd A = fill(factor, links, 30.0 * B, random);
  const Eigen::LLT<Eigen::MatrixXd> dense(A);
  ASSERT_EQ(dense.info(), Eigen::Success);
  ASSERT_TRUE(factor.factorise());
  EXPECT_EQ(factor.negative_pivots(), 0);
  const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(n * B, -1.0, 2.0);
  const Eigen::VectorXd expected = dense.solve(right);
  EXPECT_LT((solve(factor, right) - expected).norm(), 1e-12 * expected.norm())
      << n << " nodes, " << loops << " loops, blocks of " << B;
}

TEST(BlockCholesky, SolvesAsDenseCholeskyDoes) {
  for (const ChainElimination chains : {ChainElimination::on, ChainElimination::off}) {
    for (const int n : {1, 2, 3, 7, 40, 150}) {
      for (const int loops : {0, 1, 5, 60, 600}) {
        if (n == 1) continue;
        expect_dense_solution<1>(n, loops, chains);
        expect_dense_solution<2>(n, loops, chains);
        expect_dense_solution<3>(n, loops, chains);
      }
    }
  }
}

// Sylvester: the signs of D are those of the eigenvalues.
TEST(BlockCholesky, CountsNegativeEigenvalues) {
  RandomStream random(3, "inertia");
  int indefinite = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const std::vector<Link> links = links_of(30, 25, random);
    const Symbolic symbolic = analyse(adjacency_of(30, links));
    BlockCholesky<3> factor(symbolic);
    const Eigen::MatrixXd A = fill(factor, links, random.uniform(0.0, 15.0), random);
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues();
    ASSERT_TRUE(factor.factorise());
    EXPECT_EQ(factor.negative_pivots(), (eigenvalues.array() < 0.0).count());
    indefinite += factor.negative_pivots() > 0 ? 1 : 0;
    const Eigen::VectorXd right = Eigen::VectorXd::Ones(90);
    EXPECT_LT((A * solve(factor, right) - right).norm(), 1e-6);
  }
  EXPECT_GT(indefinite, 10);
}

TEST(BlockCholesky, SaysWhereItCannotFactor) {
  const std::vector<Link> links{{0, 1}};
  const Symbolic symbolic = analyse(adjacency_of(2, links));
  BlockCholesky<1> factor(symbolic);
  factor.clear();
  EXPECT_FALSE(factor.factorise());
  factor.clear();
  factor.data()[factor.place(0, 0).offset] = std::numeric_limits<double>::quiet_NaN();
  factor.data()[factor.place(1, 1).offset] = 1.0;
  EXPECT_FALSE(factor.factorise());
}

TEST(Ordering, TakesEveryNodeOnceAndChainsWithoutFill) {
  RandomStream random(5, "ordering");
  for (const int loops : {0, 3, 100}) {
    const Adjacency graph = adjacency_of(80, links_of(80, loops, random));
    for (const ChainElimination chains : {ChainElimination::on, ChainElimination::off}) {
      std::vector<int> order = elimination_order(graph, chains);
      std::sort(order.begin(), order.end());
      for (int v = 0; v < 80; ++v) EXPECT_EQ(order[static_cast<std::size_t>(v)], v);
    }
  }
  // A ring: two blocks below each column but the last two.
  std::vector<Link> ring{{0, 49}};
  for (int k = 1; k < 50; ++k) ring.push_back({k - 1, k});
  const Symbolic symbolic = analyse(adjacency_of(50, ring));
  std::size_t below = 0;
  for (const Supernode& s : symbolic.supernodes) below = std::max(below, std::size_t(s.height));
  EXPECT_LE(below, 2U);
}

TEST(SelectedInverse, EqualsTheDenseInverseOnTheDiagonal) {
  RandomStream random(7, "inverse");
  for (const int n : {2, 5, 60}) {
    for (const int loops : {0, 4, 200}) {
      for (const ChainElimination chains : {ChainElimination::on, ChainElimination::off}) {
        const std::vector<Link> links = links_of(n, loops, random);
        const Symbolic symbolic = analyse(adjacency_of(n, links), chains);
        BlockCholesky<3> factor(symbolic);
        const Eigen::MatrixXd A = fill(factor, links, 100.0, random);
        ASSERT_TRUE(factor.factorise());
        ASSERT_EQ(factor.negative_pivots(), 0);
        const Eigen::MatrixXd expected = A.inverse();
        const SelectedInverse inverse(factor);
        for (int k = 0; k < n; ++k) {
          const Eigen::Matrix3d block = expected.block<3, 3>(3 * k, 3 * k);
          EXPECT_LT((inverse.block(k) - block).norm(), 1e-12 * block.norm());
        }
      }
    }
  }
}

// All linked with all: one supernode by its pattern, which is kept as several.
TEST(BlockCholesky, KeepsAWideSupernodeInPieces) {
  RandomStream random(9, "wide");
  constexpr int kNodes = 2 * kWidestSupernode + 5;
  std::vector<Link> links;
  for (int a = 0; a < kNodes; ++a) {
    for (int b = 0; b < a; ++b) links.push_back({a, b});
  }
  const Symbolic symbolic = analyse(adjacency_of(kNodes, links));
  EXPECT_EQ(symbolic.supernodes.size(), 3U);
  for (const Supernode& s : symbolic.supernodes) EXPECT_LE(s.width, kWidestSupernode);
  BlockCholesky<3> factor(symbolic);
  const Eigen::MatrixXd A = fill(factor, links, 100.0, random);
  ASSERT_TRUE(factor.factorise());
  const Eigen::VectorXd right = Eigen::VectorXd::Ones(3 * kNodes);
  EXPECT_LT((A * solve(factor, right) - right).norm(), 1e-10);
  const Eigen::MatrixXd expected = A.inverse();
  const SelectedInverse inverse(factor);
  for (int k = 0; k < kNodes; ++k) {
    const Eigen::Matrix3d block = expected.block<3, 3>(3 * k, 3 * k);
    EXPECT_LT((inverse.block(k) - block).norm(), 1e-10 * block.norm());
  }
}

}  // namespace
}  // namespace fathom::sparse
