#include "estimators/support/sparse/block_cholesky.hpp"

#include <algorithm>

#include "estimators/support/sparse/dense_kernel.hpp"
#include "estimators/support/sparse/factorisation.hpp"
#include "estimators/support/sparse/substitution.hpp"

namespace fathom::sparse {
template <int B>
BlockCholesky<B>::BlockCholesky(const Symbolic& symbolic)
    : symbolic_(&symbolic),
      panels_(symbolic.panel_blocks * kBlockNumbers<B> + kReadAhead),
      signs_(at(symbolic.size()) * B, 1.0),
      inverses_(at(symbolic.size()) * B, 1.0) {
  int widest = 0;
  int highest = 0;
  for (const Supernode& s : symbolic.supernodes) {
    widest = std::max(widest, s.width);
    highest = std::max(highest, s.height);
  }
  packed_.resize(at(widest) * kBlockNumbers<B>);
  gathered_.resize(at(highest) * B);
}

template <int B>
void BlockCholesky<B>::clear() {
  std::fill(panels_.begin(), panels_.end(), 0.0);
}

template <int B>
BlockPlace BlockCholesky<B>::place(int node_a, int node_b) const {
  const auto [column, row] =
      std::minmax(symbolic_->position[at(node_a)], symbolic_->position[at(node_b)]);
  const Supernode& s = symbolic_->supernodes[at(symbolic_->supernode_of[at(column)])];
  const int stride = s.panel_rows() * B;
  return {s.panel * kBlockNumbers<B> + at((column - s.first) * B) * at(stride) +
              at(symbolic_->panel_row(row, s) * B),
          stride};
}

template <int B>
bool BlockCholesky<B>::factorise() {
  Factorisation<B> run{*symbolic_, panels_.data(),  signs_.data(), packed_.data(),
                       0,          inverses_.data()};
  const bool done = run_for_processor(run);
  negative_pivots_ = run.negative;
  return done;
}

template <int B>
void BlockCholesky<B>::solve(double* x) {
  const double* signs = negative_pivots_ > 0 ? signs_.data() : nullptr;
  Substitution<B> run{*symbolic_, panels_.data(), signs, inverses_.data(), x, gathered_.data()};
  run_for_processor(run);
}

template class BlockCholesky<1>;
template class BlockCholesky<2>;
template class BlockCholesky<3>;

}  // namespace fathom::sparse
