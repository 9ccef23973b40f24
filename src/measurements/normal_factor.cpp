#include "normal_factor.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace fathom {
namespace {

// Of a pivot, as a part of its diagonal element: below it holds rounding alone.
constexpr double kSmallestPivot = 64.0 * std::numeric_limits<double>::epsilon();

// The lower triangle of Bᵀ D B, with the pattern of Bᵀ B whatever the diagonal D is.
Eigen::SparseMatrix<double> normal_matrix(const Eigen::SparseMatrix<double>& B,
                                          const Eigen::VectorXd& D) {
  const Eigen::SparseMatrix<double> square = B.transpose() * (D.asDiagonal() * B);
  return square.triangularView<Eigen::Lower>();
}

std::size_t at(Eigen::Index i) {
  return static_cast<std::size_t>(i);
}

Eigen::Index first_of(int triple) {
  return 3 * static_cast<Eigen::Index>(triple);
}

}  // namespace

NormalFactor::NormalFactor(const Eigen::SparseMatrix<double>& B, const Eigen::VectorXd& is_own_row)
    : blocks_(blocks_of(normal_matrix(B, (1.0 - is_own_row.array()).matrix()),
                        normal_matrix(B, is_own_row))),
      symbolic_(pattern_of(static_cast<int>(B.cols() / 3), blocks_)),
      factor_(symbolic_) {
  const std::vector<int>& position = symbolic_.position;
  for (Block& block : blocks_) {
    block.place = factor_.place(block.row, block.column);
    if (position[at(block.row)] >= position[at(block.column)]) continue;
    std::swap(block.row, block.column);
    block.rest.transposeInPlace();
    block.own.transposeInPlace();
  }
}

std::vector<NormalFactor::Block> NormalFactor::blocks_of(const Eigen::SparseMatrix<double>& rest,
                                                         const Eigen::SparseMatrix<double>& own) {
  using Elements = Eigen::SparseMatrix<double>::InnerIterator;
  std::vector<Block> blocks;
  std::vector<int> block_of(at(rest.cols() / 3), -1);  // by row, of the column that is read
  for (Index column = 0; column < rest.cols(); ++column) {
    if (column % 3 == 0) std::fill(block_of.begin(), block_of.end(), -1);
    Elements of_own(own, column);
    for (Elements of_rest(rest, column); of_rest; ++of_rest, ++of_own) {
      const Index row = of_rest.row();
      int& found = block_of[at(row / 3)];
      if (found < 0) {
        found = static_cast<int>(blocks.size());
        blocks.push_back({static_cast<int>(row / 3), static_cast<int>(column / 3)});
      }
      blocks[at(found)].rest(row % 3, column % 3) = of_rest.value();
      blocks[at(found)].own(row % 3, column % 3) = of_own.value();
    }
  }
  for (Block& block : blocks) {
    if (block.row != block.column) continue;
    block.rest = Eigen::Matrix3d(block.rest.selfadjointView<Eigen::Lower>());
    block.own = Eigen::Matrix3d(block.own.selfadjointView<Eigen::Lower>());
  }
  return blocks;
}

sparse::Symbolic NormalFactor::pattern_of(int triples, const std::vector<Block>& blocks) {
  std::vector<sparse::Link> links;
  for (const Block& block : blocks) {
    if (block.row != block.column) links.push_back({block.row, block.column});
  }
  return sparse::analyse(sparse::adjacency_of(triples, links));
}

// The factor is of H with the rows in the order of elimination.
bool NormalFactor::factorise(const Eigen::VectorXd& scale, double own_weight, Index first_prior) {
  inverse_.reset();
  scale_ = scale;
  factor_.clear();
  Eigen::VectorXd diagonal(scale.size());
  for (const Block& block : blocks_) {
    Eigen::Matrix3d H = scale.segment<3>(first_of(block.row)).asDiagonal() *
                        (block.rest + own_weight * block.own) *
                        scale.segment<3>(first_of(block.column)).asDiagonal();
    if (block.row == block.column) {
      if (first_of(block.row) >= first_prior) H += Eigen::Matrix3d::Identity();
      diagonal.segment<3>(first_of(symbolic_.position[at(block.row)])) = H.diagonal();
    }
    Eigen::Map<Eigen::Matrix3d, 0, Eigen::OuterStride<>>(
        factor_.data() + block.place.offset, Eigen::OuterStride<>(block.place.stride)) = H;
  }
  if (!factor_.factorise(sparse::Inertia::positive)) return false;
  return (factor_.diagonal().square() > kSmallestPivot * diagonal.array()).all();
}

double NormalFactor::log_determinant() const {
  return 2.0 * factor_.diagonal().log().sum();
}

Eigen::MatrixXd NormalFactor::solve(const Eigen::MatrixXd& b) {
  Eigen::MatrixXd x(b.rows(), b.cols());
  Eigen::VectorXd ordered(b.rows());
  for (Index column = 0; column < b.cols(); ++column) {
    for (int i = 0; i < symbolic_.size(); ++i) {
      ordered.segment<3>(first_of(symbolic_.position[at(i)])) =
          b.col(column).segment<3>(first_of(i));
    }
    factor_.solve(ordered.data());
    for (int i = 0; i < symbolic_.size(); ++i) {
      x.col(column).segment<3>(first_of(i)) =
          ordered.segment<3>(first_of(symbolic_.position[at(i)]));
    }
  }
  return x;
}

Eigen::Matrix3d NormalFactor::inverse(Index a, Index b) {
  if (!inverse_) inverse_.emplace(factor_);
  if (a == b) return inverse_->block(static_cast<int>(a));
  return inverse_->block(static_cast<int>(a), static_cast<int>(b));
}

double NormalFactor::own_trace() {
  double sum = 0.0;
  for (const Block& block : blocks_) {
    const Eigen::Matrix3d own = scale_.segment<3>(first_of(block.row)).asDiagonal() * block.own *
                                scale_.segment<3>(first_of(block.column)).asDiagonal();
    const double times = block.row == block.column ? 1.0 : 2.0;
    sum += times * own.cwiseProduct(inverse(block.row, block.column)).sum();
  }
  return sum;
}

}  // namespace fathom
