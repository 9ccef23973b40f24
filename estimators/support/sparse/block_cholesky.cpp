#include "estimators/support/sparse/block_cholesky.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

#include "estimators/support/sparse/dense_kernel.hpp"
#include "estimators/support/sparse/shared_factorisation.hpp"
#include "estimators/support/sparse/shared_substitution.hpp"

namespace fathom::sparse {
namespace {

// Between what two threads write: a cache line, and one that the processor fetches beside it.
constexpr std::size_t kApart = 16;
// Numbers, 2 MiB.
constexpr std::size_t kClearedAtOnce = std::size_t{1} << 18;

}  // namespace

template <int B>
std::size_t BlockCholesky<B>::numbers_of(const Symbolic& symbolic) {
  return symbolic.panel_blocks * kBlockNumbers<B> + kReadAhead;
}

template <int B>
BlockCholesky<B>::BlockCholesky(const Symbolic& symbolic)
    : BlockCholesky(symbolic, PanelMemory(numbers_of(symbolic), symbolic.workers)) {}

template <int B>
BlockCholesky<B>::BlockCholesky(const Symbolic& symbolic, PanelMemory panels)
    : symbolic_(&symbolic),
      panels_(std::move(panels)),
      signs_(at(symbolic.size()) * B, 1.0),
      inverses_(at(symbolic.size()) * B, 1.0) {
  int widest = 0;
  int highest = 0;
  for (const Supernode& s : symbolic.supernodes) {
    widest = std::max(widest, s.width);
    highest = std::max(highest, s.height);
  }
  packed_numbers_ = at(widest) * kBlockNumbers<B> + kApart;
  gathered_numbers_ = at(highest) * B + kApart;
  const std::size_t threads = symbolic.workers == nullptr ? 1 : at(symbolic.workers->size());
  packed_.resize(threads * packed_numbers_);
  gathered_.resize(threads * gathered_numbers_);
  deferred_.resize(symbolic.cut.deferred_rows * B);
}

template <int B>
void BlockCholesky<B>::clear() {
  double* const numbers = panels_.begin();
  for_ranges(symbolic_->workers, at(panels_.end() - numbers), kClearedAtOnce,
             [numbers](std::size_t begin, std::size_t end) {
               std::memset(numbers + begin, 0, (end - begin) * sizeof(double));
             });
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
Factorisation<B> BlockCholesky<B>::factorisation(int thread, Inertia inertia) {
  return {
      *symbolic_, panels_.data(),   signs_.data(), packed_.data() + at(thread) * packed_numbers_,
      0,          inverses_.data(), inertia};
}

template <int B>
bool BlockCholesky<B>::factorise(Inertia inertia, double* b) {
  if (!symbolic_->cut.is_empty()) return factorise_shared(inertia);
  Factorisation<B> run = factorisation(0, inertia);
  const Substitution<B> forward = substitution(b, 0);
  if (b != nullptr) run.forward = &forward;
  const bool done = run_for_processor(run);
  negative_pivots_ = run.negative;
  return done;
}

template <int B>
void BlockCholesky<B>::take_factor() {
  const Factorisation<B> run = factorisation(0);
  for (const Supernode& s : symbolic_->supernodes) {
    run.invert_diagonal(s, panel(s), s.panel_rows() * B);
  }
  negative_pivots_ = 0;
}

template <int B>
Eigen::ArrayXd BlockCholesky<B>::diagonal() const {
  return Eigen::Map<const Eigen::ArrayXd>(inverses_.data(), std::ssize(inverses_)).inverse();
}

template <int B>
bool BlockCholesky<B>::factorise_shared(Inertia inertia) {
  const int threads = symbolic_->workers->size();
  FactorisationProgress progress(symbolic_->cut, threads);
  symbolic_->workers->run([&](int thread) {
    SharedFactorisation<B> part{factorisation(thread, inertia), progress, threads};
    run_for_processor(part);
  });
  negative_pivots_ = progress.negative;
  return !progress.has_failed() && (inertia == Inertia::any || progress.negative == 0);
}

template <int B>
Substitution<B> BlockCholesky<B>::substitution(double* x, int thread) {
  return {*symbolic_,
          panels_.data(),
          negative_pivots_ > 0 ? signs_.data() : nullptr,
          inverses_.data(),
          x,
          gathered_.data() + at(thread) * gathered_numbers_};
}

template <int B>
void BlockCholesky<B>::solve(double* x) {
  if (!symbolic_->cut.is_empty()) return solve_shared(x);
  Substitution<B> run = substitution(x, 0);
  run_for_processor(run);
}

template <int B>
void BlockCholesky<B>::solve_begun(double* b) {
  if (!symbolic_->cut.is_empty()) return solve_shared(b);
  Substitution<B> run = substitution(b, 0);
  run.is_forward_done = true;
  run_for_processor(run);
}

template <int B>
void BlockCholesky<B>::solve_transposed(double* x) {
  const Substitution<B> run = substitution(x, 0);
  const std::vector<Supernode>& all = symbolic_->supernodes;
  for (std::size_t i = all.size(); i > 0; --i) run.backward(all[i - 1]);
}

template <int B>
void BlockCholesky<B>::solve_shared(double* x) {
  SubstitutionProgress progress(symbolic_->workers->size());
  symbolic_->workers->run([&](int thread) {
    SharedSubstitution<B> part{substitution(x, thread), progress, deferred_.data(), thread == 0};
    run_for_processor(part);
  });
}

template class BlockCholesky<1>;
template class BlockCholesky<2>;
template class BlockCholesky<3>;

}  // namespace fathom::sparse
