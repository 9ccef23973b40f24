#include "estimators/support/sparse/row_elimination.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <Eigen/QR>

namespace fathom::sparse {
namespace {

constexpr Eigen::Index kBlock = 3;

// The rows of a supernode and of its children's remainders, dense; the last column is the right
// side.
class RowElimination {
 public:
  RowElimination(std::span<const LeastSquaresRows> rows, BlockCholesky<3>& factor)
      : rows_(rows),
        factor_(factor),
        symbolic_(factor.symbolic()),
        own_(symbolic_.supernodes.size()),
        children_(symbolic_.supernodes.size()),
        left_(symbolic_.supernodes.size()),
        squared_norms_(Eigen::VectorXd::Zero(kBlock * symbolic_.size())) {
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (rows[r].blocks.empty()) continue;
      int first = symbolic_.size();
      for (const auto& [position, J] : rows[r].blocks) {
        first = std::min(first, position);
        squared_norms_.segment<kBlock>(kBlock * position) += J.colwise().squaredNorm().transpose();
      }
      own_[at(symbolic_.supernode_of[at(first)])].push_back(r);
    }
  }

  bool run(double least_share, double* y) {
    factor_.clear();
    for (std::size_t i = 0; i < own_.size(); ++i) {
      const Supernode& s = symbolic_.supernodes[i];
      Eigen::MatrixXd front = heaviest_first(gathered(i));
      Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> in_place(front);
      if (!write(s, front, least_share, y)) return false;
      if (s.height > 0) hand_on(i, front);
    }
    factor_.take_factor();
    return true;
  }

 private:
  Eigen::MatrixXd gathered(std::size_t i) {
    const Supernode& s = symbolic_.supernodes[i];
    Eigen::Index count = kBlock * static_cast<Eigen::Index>(own_[i].size());
    for (const std::size_t child : children_[i]) count += left_[child].rows();
    Eigen::MatrixXd front = Eigen::MatrixXd::Zero(count, kBlock * s.panel_rows() + 1);
    Eigen::Index next = 0;
    for (const std::size_t r : own_[i]) {
      for (const auto& [position, J] : rows_[r].blocks) {
        front.block<kBlock, kBlock>(next, kBlock * symbolic_.panel_row(position, s)) += J;
      }
      front.rightCols<1>().segment<kBlock>(next) = rows_[r].right;
      next += kBlock;
    }
    for (const std::size_t child : children_[i]) {
      const Supernode& c = symbolic_.supernodes[child];
      const Eigen::MatrixXd& left = left_[child];
      for (int j = 0; j < c.height; ++j) {
        const int column = symbolic_.panel_row(symbolic_.rows[at(c.rows + j)], s);
        front.block(next, kBlock * column, left.rows(), kBlock) =
            left.middleCols<kBlock>(kBlock * j);
      }
      front.rightCols<1>().segment(next, left.rows()) = left.rightCols<1>();
      next += left.rows();
      left_[child].resize(0, 0);
    }
    return front;
  }

  // Then what a light row says is not lost in the rounding of a heavy one's reflection (Cox and
  // Higham 1998, docs/estimators/sparse_gauss_newton.md).
  static Eigen::MatrixXd heaviest_first(const Eigen::MatrixXd& front) {
    const Eigen::VectorXd weights = front.cwiseAbs().rowwise().maxCoeff();
    std::vector<Eigen::Index> order(static_cast<std::size_t>(front.rows()));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::ranges::stable_sort(
        order, [&](Eigen::Index a, Eigen::Index b) { return weights(a) > weights(b); });
    return front(order, Eigen::all);
  }

  bool write(const Supernode& s, const Eigen::MatrixXd& front, double least_share, double* y) {
    const Eigen::Index width = kBlock * s.width;
    if (front.rows() < width) return false;
    const Eigen::Index stride = kBlock * s.panel_rows();
    double* panel = factor_.data() + s.panel * kBlockNumbers<kBlock>;
    for (Eigen::Index k = 0; k < width; ++k) {
      const double pivot = front(k, k);
      const double least = least_share * std::sqrt(squared_norms_(kBlock * s.first + k));
      if (!(std::abs(pivot) > least) || !std::isfinite(pivot)) return false;
      const double sign = pivot > 0.0 ? 1.0 : -1.0;
      for (Eigen::Index i = k; i < stride; ++i) panel[i + k * stride] = sign * front(k, i);
      y[kBlock * s.first + k] = sign * front(k, stride);
    }
    return true;
  }

  void hand_on(std::size_t i, const Eigen::MatrixXd& front) {
    const Supernode& s = symbolic_.supernodes[i];
    const Eigen::Index width = kBlock * s.width;
    const Eigen::Index columns = front.cols() - width;
    const Eigen::Index count = std::min(front.rows() - width, columns);
    left_[i] = front.block(width, width, count, columns).triangularView<Eigen::Upper>();
    children_[at(symbolic_.supernode_of[at(symbolic_.rows[at(s.rows)])])].push_back(i);
  }

  std::span<const LeastSquaresRows> rows_;
  BlockCholesky<3>& factor_;
  const Symbolic& symbolic_;
  std::vector<std::vector<std::size_t>> own_;       ///< rows that a supernode is first of
  std::vector<std::vector<std::size_t>> children_;  ///< by supernode
  std::vector<Eigen::MatrixXd> left_;               ///< what a supernode leaves for its parent
  Eigen::VectorXd squared_norms_;                   ///< of the columns of J
};

}  // namespace

bool eliminate_rows(std::span<const LeastSquaresRows> rows, double least_share,
                    BlockCholesky<3>& factor, double* y) {
  return RowElimination(rows, factor).run(least_share, y);
}

}  // namespace fathom::sparse
