#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "estimators/support/sparse/panel_memory.hpp"
#include "estimators/support/sparse/symbolic.hpp"

namespace fathom::sparse {

template <int B>
struct Factorisation;
template <int B>
struct Substitution;

/// Where a block lies: its first element and the distance between its columns.
struct BlockPlace {
  std::size_t offset = 0;
  int stride = 0;
};

/// A = L D Lᵀ of a sparse symmetric matrix of B × B blocks, D = diag(±1), without pivoting: the
/// Cholesky factor where A is positive definite; else the count of −1 is the number of negative
/// eigenvalues (Sylvester), as long as no pivot vanishes.
///
/// Supernodes are dense column-major panels. Each is factored by block columns and then subtracts
/// its products from the later ones: all arithmetic is in one small dense kernel.
template <int B>
class BlockCholesky {
 public:
  /// The pattern must outlive it and stay as it is. A holds nothing before the first clear().
  explicit BlockCholesky(const Symbolic& symbolic);
  /// In the memory of a factor of larger blocks with the same pattern, whose numbers are lost.
  template <int Larger>
  explicit BlockCholesky(BlockCholesky<Larger>& lender)
      : BlockCholesky(lender.symbolic(),
                      PanelMemory(lender.data(), numbers_of(lender.symbolic()))) {
    static_assert(Larger > B);
  }

  /// Sets A to zero, before it is added up.
  void clear();
  /// The place of block (a, b) of nodes: in the row of the one that is eliminated later. Of a
  /// diagonal block only the lower triangle counts.
  BlockPlace place(int node_a, int node_b) const;
  double* data() { return panels_.data(); }
  const double* data() const { return panels_.data(); }

  /// False where a pivot is zero or not a number; of Inertia::positive also where one is negative,
  /// which then need not be counted to the end. `b`: a right side that solve_begun() will solve
  /// for, begun while the factor is in the cache.
  bool factorise(Inertia inertia = Inertia::any, double* b = nullptr);
  /// L of a positive definite A was written in the place of A.
  void take_factor();
  int negative_pivots() const { return negative_pivots_; }
  /// Of the last factor L, if A is positive definite: a number a scalar column, in the order of
  /// elimination.
  Eigen::ArrayXd diagonal() const;

  /// Solves A x = b in place; B numbers a node, in the order of elimination.
  void solve(double* x);
  /// The same of the right side that the last factorise() was given.
  void solve_begun(double* b);
  /// Solves Lᵀ x = b in place, of a positive definite A.
  void solve_transposed(double* x);

  const Symbolic& symbolic() const { return *symbolic_; }
  const double* panel(const Supernode& s) const {
    return panels_.data() + s.panel * kBlockNumbers<B>;
  }

 private:
  BlockCholesky(const Symbolic& symbolic, PanelMemory panels);
  static std::size_t numbers_of(const Symbolic& symbolic);

  Factorisation<B> factorisation(int thread, Inertia inertia = Inertia::any);
  Substitution<B> substitution(double* x, int thread);
  bool factorise_shared(Inertia inertia);
  void solve_shared(double* x);

  const Symbolic* symbolic_;
  std::size_t packed_numbers_ = 0;    ///< of a thread
  std::size_t gathered_numbers_ = 0;  ///< likewise
  PanelMemory panels_;
  std::vector<double> signs_;     ///< D, one sign a scalar column
  std::vector<double> inverses_;  ///< 1 / the diagonal of L, likewise
  std::vector<double> packed_;    ///< right sides of products, of each thread
  std::vector<double> gathered_;  ///< the rows below a supernode, of each thread
  std::vector<double> deferred_;  ///< what branches subtract from the top of a right side
  int negative_pivots_ = 0;
};

extern template class BlockCholesky<1>;
extern template class BlockCholesky<2>;
extern template class BlockCholesky<3>;

}  // namespace fathom::sparse
