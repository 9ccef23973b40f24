// The block Cholesky factorisation by several threads: the bits of one thread, whatever the shape
// of the matrix.

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "estimators/support/sparse/block_cholesky.hpp"
#include "fathom/core/random.hpp"

namespace fathom::sparse {
namespace {

struct Shape {
  std::string name;
  int nodes = 0;
  std::vector<Link> links;
};

Shape chain(int nodes) {
  Shape shape{"chain of " + std::to_string(nodes), nodes, {}};
  for (int k = 1; k < nodes; ++k) shape.links.push_back({k - 1, k});
  return shape;
}

// Separators of about `side` nodes.
Shape grid(int side, int along) {
  Shape shape{"grid of " + std::to_string(side) + " x " + std::to_string(along), side * along, {}};
  for (int y = 0; y < along; ++y) {
    for (int x = 0; x < side; ++x) {
      const int k = y * side + x;
      if (x > 0) shape.links.push_back({k - 1, k});
      if (y > 0) shape.links.push_back({k - side, k});
    }
  }
  return shape;
}

// Each of so many nodes linked with each: one separator, and nothing below it.
Shape clique(int nodes) {
  Shape shape{"clique of " + std::to_string(nodes), nodes, {}};
  for (int a = 0; a < nodes; ++a) {
    for (int b = 0; b < a; ++b) shape.links.push_back({b, a});
  }
  return shape;
}

Shape star(int nodes) {
  Shape shape{"star of " + std::to_string(nodes), nodes, {}};
  for (int k = 1; k < nodes; ++k) shape.links.push_back({0, k});
  return shape;
}

Shape beside(const Shape& a, const Shape& b) {
  Shape shape{a.name + " beside " + b.name, a.nodes + b.nodes, a.links};
  for (const Link& link : b.links) shape.links.push_back({a.nodes + link.a, a.nodes + link.b});
  return shape;
}

Shape trajectory_with_loops(int nodes, int loops) {
  Shape shape = chain(nodes);
  shape.name += " with " + std::to_string(loops) + " loops";
  RandomStream random(5, "loops");
  for (int j = 0; j < loops; ++j) {
    const int a = static_cast<int>(random.uniform(0.0, nodes - 1));
    const int b = static_cast<int>(random.uniform(0.0, nodes - 1));
    if (a != b) shape.links.push_back({a, b});
  }
  return shape;
}

std::vector<Shape> shapes() {
  return {{"nothing", 0, {}},
          {"one node", 1, {}},
          {"nodes without links", 40, {}},
          chain(2),
          chain(3000),
          grid(6, 400),
          grid(45, 45),
          clique(3),
          clique(150),
          star(500),
          trajectory_with_loops(1500, 500),
          beside(grid(25, 25), beside(chain(300), clique(70)))};
}

// The same numbers whatever the layout of the panels. `shift` on the diagonal makes the matrix
// definite or not.
template <int B>
void fill(BlockCholesky<B>& factor, const Shape& shape, double shift) {
  RandomStream random(7, "blocks");
  factor.clear();
  const auto add = [&](int a, int b, double more) {
    const BlockPlace place = factor.place(a, b);
    double* const block = factor.data() + place.offset;
    for (int j = 0; j < B; ++j) {
      for (int i = 0; i < B; ++i) block[i + j * place.stride] += random.normal();
      block[j + j * place.stride] += more;
    }
  };
  for (int k = 0; k < shape.nodes; ++k) add(k, k, shift);
  for (const Link& link : shape.links) add(link.a, link.b, 0.0);
}

struct Result {
  bool is_done = false;
  int negative_pivots = 0;
  std::vector<double> L;  ///< of all panels, on and below the diagonal block
  std::vector<double> x;

  bool operator==(const Result&) const = default;
};

template <int B>
Result factored(const Shape& shape, const Symbolic& symbolic, double shift) {
  BlockCholesky<B> factor(symbolic);
  fill(factor, shape, shift);
  Result result{factor.factorise(), 0, {}, {}};
  if (!result.is_done) return result;
  result.negative_pivots = factor.negative_pivots();
  for (const Supernode& s : symbolic.supernodes) {
    const int rows = s.panel_rows() * B;
    for (int column = 0; column < s.width * B; ++column) {
      const double* from = factor.panel(s) + at(column) * at(rows);
      result.L.insert(result.L.end(), from + column, from + rows);
    }
  }
  RandomStream random(9, "right side");
  result.x.resize(at(B * shape.nodes));
  for (double& x : result.x) x = random.normal();
  // Twice: what the first leaves behind must not be seen by the second.
  for (int i = 0; i < 2; ++i) factor.solve(result.x.data());
  return result;
}

template <int B>
void expect_bits_of_one_thread(const Shape& shape, double shift, bool is_done) {
  const Adjacency graph = adjacency_of(shape.nodes, shape.links);
  const Result alone = factored<B>(shape, analyse(graph), shift);
  EXPECT_EQ(alone.is_done, is_done) << shape.name;
  for (const int threads : {2, 3, 7}) {
    Workers workers(threads);
    const Symbolic symbolic = analyse(graph, ChainElimination::on, &workers, 0);
    ASSERT_EQ(symbolic.workers, &workers);
    EXPECT_TRUE(factored<B>(shape, symbolic, shift) == alone)
        << shape.name << ", blocks of " << B << ", " << threads << " threads";
  }
}

TEST(SharedFactor, HasTheBitsOfOneThread) {
  for (const Shape& shape : shapes()) {
    const double shift = 20.0 + 4.0 * shape.nodes;
    expect_bits_of_one_thread<1>(shape, shift, true);
    expect_bits_of_one_thread<2>(shape, shift, true);
    expect_bits_of_one_thread<3>(shape, shift, true);
  }
}

TEST(SharedFactor, HasThemWhereTheMatrixIsIndefinite) {
  const Shape shape = grid(30, 30);
  const Adjacency graph = adjacency_of(shape.nodes, shape.links);
  EXPECT_GT(factored<3>(shape, analyse(graph), 0.0).negative_pivots, 100);
  expect_bits_of_one_thread<1>(shape, 0.0, true);
  expect_bits_of_one_thread<2>(shape, 0.0, true);
  expect_bits_of_one_thread<3>(shape, 0.0, true);
}

// Wherever the pivot is that vanishes, in a branch or in the top, all threads come back.
TEST(SharedFactor, FailsWhereOneThreadDoes) {
  const Shape shape = grid(40, 40);
  const Adjacency graph = adjacency_of(shape.nodes, shape.links);
  Workers workers(3);
  const Symbolic symbolic = analyse(graph, ChainElimination::on, &workers, 0);
  ASSERT_FALSE(symbolic.cut.top.empty());
  ASSERT_GT(symbolic.cut.branches.size(), 3u);
  for (int position = 0; position < symbolic.size(); position += 37) {
    BlockCholesky<2> factor(symbolic);
    fill(factor, shape, 1e4);
    const int node = symbolic.node[at(position)];
    factor.data()[factor.place(node, node).offset] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(factor.factorise()) << "position " << position;
  }
}

TEST(TreeCut, LeavesAChainAloneAndSharesAGrid) {
  Workers workers(2);
  const auto cut = [&](const Shape& shape) {
    return analyse(adjacency_of(shape.nodes, shape.links), ChainElimination::on, &workers, 0).cut;
  };
  EXPECT_TRUE(cut(chain(3000)).is_empty());
  EXPECT_FALSE(cut(clique(150)).is_empty());
  const TreeCut wide = cut(grid(45, 45));
  EXPECT_GT(wide.branches.size(), 4u);
  EXPECT_GT(wide.steps.size(), 3u);
}

TEST(TreeCut, HasAllSupernodesOnce) {
  for (const Shape& shape : shapes()) {
    Workers workers(2);
    const Symbolic symbolic =
        analyse(adjacency_of(shape.nodes, shape.links), ChainElimination::on, &workers, 0);
    if (symbolic.cut.is_empty()) continue;
    std::vector<int> seen(symbolic.supernodes.size(), 0);
    for (const int s : symbolic.cut.top) ++seen[at(s)];
    for (const Branch& branch : symbolic.cut.branches) {
      for (int s = branch.begin; s < branch.end; ++s) ++seen[at(s)];
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ssize(seen)) << shape.name;
  }
}

// What a branch subtracts goes into itself or to the top; else two threads would meet.
TEST(TreeCut, BranchesAreApart) {
  for (const Shape& shape : shapes()) {
    Workers workers(3);
    const Symbolic symbolic =
        analyse(adjacency_of(shape.nodes, shape.links), ChainElimination::on, &workers, 0);
    const std::vector<int>& top = symbolic.cut.top;
    for (const Branch& branch : symbolic.cut.branches) {
      for (int i = branch.begin; i < branch.end; ++i) {
        const Supernode& s = symbolic.supernodes[at(i)];
        for (int u = s.updates; u < s.updates + s.update_count; ++u) {
          const int target = symbolic.updates[at(u)].target;
          EXPECT_TRUE(target < branch.end || std::binary_search(top.begin(), top.end(), target))
              << shape.name;
        }
      }
    }
  }
}

}  // namespace
}  // namespace fathom::sparse
