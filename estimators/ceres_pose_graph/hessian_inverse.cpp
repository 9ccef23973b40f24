#include "estimators/ceres_pose_graph/hessian_inverse.hpp"

#include <algorithm>

#include <Eigen/QR>
#include <Eigen/SparseCholesky>

#include "fathom/estimation/precision.hpp"

namespace fathom {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Ldlt = Eigen::SimplicialLDLT<Sparse, Eigen::Lower>;

/// Z = (L D Lᵀ)⁻¹ within the pattern of L, unit lower triangular, its diagonal not stored.
class TakahashiInverse {
 public:
  TakahashiInverse(const Sparse& L, const Eigen::VectorXd& D)
      : L_(L), lower_(static_cast<std::size_t>(L.nonZeros()), 0.0), diagonal_(D.size()) {
    for (Eigen::Index j = L.cols() - 1; j >= 0; --j) make_column(j, D(j));
  }

  double at(Eigen::Index a, Eigen::Index b) const {
    if (a == b) return diagonal_(a);
    const auto [column, row] = std::minmax(a, b);
    const int* rows = L_.innerIndexPtr();
    const int* end = rows + end_of(column);
    const int* found = std::lower_bound(rows + begin_of(column), end, static_cast<int>(row));
    return found == end || *found != row ? 0.0 : lower_[static_cast<std::size_t>(found - rows)];
  }

 private:
  Eigen::Index begin_of(Eigen::Index column) const { return L_.outerIndexPtr()[column]; }
  Eigen::Index end_of(Eigen::Index column) const { return L_.outerIndexPtr()[column + 1]; }
  double& lower(Eigen::Index entry) { return lower_[static_cast<std::size_t>(entry)]; }

  // Z_ij = −Σ_r Z_ir L_rj and Z_jj = 1/D_j − Σ_r L_rj Z_rj, over the rows r > j of column j of L.
  // For each pair of them the later one is a row of the earlier one's column, too, so both are
  // walked along together.
  void make_column(Eigen::Index j, double D_j) {
    const int* rows = L_.innerIndexPtr();
    const double* L = L_.valuePtr();
    for (Eigen::Index a = begin_of(j); a < end_of(j); ++a) {
      lower(a) -= diagonal_(rows[a]) * L[a];
      Eigen::Index entry = begin_of(rows[a]);
      for (Eigen::Index b = a + 1; b < end_of(j); ++b) {
        while (rows[entry] < rows[b]) ++entry;
        lower(a) -= lower(entry) * L[b];
        lower(b) -= lower(entry) * L[a];
      }
    }
    diagonal_(j) = 1.0 / D_j;
    for (Eigen::Index a = begin_of(j); a < end_of(j); ++a) diagonal_(j) -= L[a] * lower(a);
  }

  const Sparse& L_;
  std::vector<double> lower_;  ///< of the entries of L, in their order
  Eigen::VectorXd diagonal_;
};

bool is_definite(const Ldlt& ldlt) {
  return ldlt.info() == Eigen::Success && (ldlt.vectorD().array() > 0.0).all();
}

Sparse hessian_of(const Sparse& jacobian) {
  return jacobian.transpose() * jacobian;
}

bool keeps_digits(const Ldlt& ldlt, const Sparse& hessian) {
  if (!is_definite(ldlt)) return false;
  const Eigen::VectorXd sums = ldlt.permutationP() * hessian.diagonal();
  return (ldlt.vectorD().array() > kLeastPivotShare * sums.array()).all();
}

// R of J = Q R, and Qᵀ b in a further column; nothing where a pivot is rounding.
std::optional<Eigen::MatrixXd> triangle_of(const Sparse& jacobian, const Eigen::VectorXd& b) {
  const Eigen::Index columns = jacobian.cols();
  if (columns > kMostDenseColumns || jacobian.rows() < columns) return std::nullopt;
  Eigen::MatrixXd rows(jacobian.rows(), columns + 1);
  rows << Eigen::MatrixXd(jacobian), b;
  const Eigen::VectorXd norms = rows.leftCols(columns).colwise().norm();
  const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> in_place(rows);
  const auto pivots = rows.diagonal().head(columns).array().abs();
  if (!(pivots > kLeastPivotShare * norms.array()).all()) return std::nullopt;
  return rows.topRows(columns);
}

std::optional<Eigen::MatrixXd> inverse_by_rows(const Sparse& jacobian) {
  const auto R = triangle_of(jacobian, Eigen::VectorXd::Zero(jacobian.rows()));
  if (!R) return std::nullopt;
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(R->rows(), R->rows());
  R->leftCols(R->rows()).triangularView<Eigen::Upper>().solveInPlace(inverse);
  return inverse * inverse.transpose();
}

// The three columns of the inverse that start with this one.
Eigen::MatrixX3d columns_of_inverse(const Ldlt& ldlt, Eigen::Index first) {
  Eigen::MatrixX3d columns = Eigen::MatrixX3d::Zero(ldlt.rows(), 3);
  columns.middleRows<3>(first).setIdentity();
  return ldlt.solve(columns);
}

}  // namespace

bool keeps_digits(const Sparse& jacobian) {
  const Sparse hessian = hessian_of(jacobian);
  return keeps_digits(Ldlt(hessian), hessian);
}

bool is_determined(const Sparse& jacobian) {
  return triangle_of(jacobian, Eigen::VectorXd::Zero(jacobian.rows())).has_value();
}

std::optional<double> decrease_of_step(const Sparse& jacobian, const Eigen::VectorXd& residuals) {
  const Ldlt ldlt(hessian_of(jacobian));
  if (!is_definite(ldlt)) return std::nullopt;
  const Eigen::VectorXd gradient = jacobian.transpose() * residuals;
  return 0.5 * gradient.dot(ldlt.solve(gradient));
}

std::optional<double> decrease_by_rows(const Sparse& jacobian, const Eigen::VectorXd& residuals) {
  const auto R = triangle_of(jacobian, residuals);
  if (!R) return std::nullopt;
  return 0.5 * R->rightCols<1>().squaredNorm();
}

std::optional<InverseBlocks> inverse_blocks(const Sparse& jacobian, std::size_t count) {
  const Sparse hessian = hessian_of(jacobian);
  const Ldlt ldlt(hessian);
  const auto size = static_cast<Eigen::Index>(3 * count);
  InverseBlocks blocks;
  if (!keeps_digits(ldlt, hessian)) {
    const auto inverse = inverse_by_rows(jacobian);
    if (!inverse) return std::nullopt;
    for (Eigen::Index k = 0; k < size; k += 3) {
      blocks.own.push_back(inverse->block<3, 3>(k, k));
      blocks.with_last.push_back(inverse->block<3, 3>(k, size - 3));
    }
    return blocks;
  }
  const Eigen::MatrixX3d last = columns_of_inverse(ldlt, size - 3);
  const Sparse& L = ldlt.matrixL().nestedExpression();
  const TakahashiInverse inverse(L, ldlt.vectorD());
  const auto& place = ldlt.permutationP().indices();
  for (Eigen::Index k = 0; k < size; k += 3) {
    Eigen::Matrix3d own;
    for (Eigen::Index r = 0; r < 3; ++r) {
      for (Eigen::Index c = 0; c < 3; ++c) own(r, c) = inverse.at(place(k + r), place(k + c));
    }
    blocks.own.push_back(own);
    blocks.with_last.push_back(last.middleRows<3>(k));
  }
  return blocks;
}

std::optional<Eigen::MatrixXd> inverse_between(const Sparse& jacobian,
                                               std::span<const std::size_t> blocks) {
  const Sparse hessian = hessian_of(jacobian);
  const Ldlt ldlt(hessian);
  std::optional<Eigen::MatrixXd> dense;
  if (!keeps_digits(ldlt, hessian)) {
    dense = inverse_by_rows(jacobian);
    if (!dense) return std::nullopt;
  }
  const auto size = static_cast<Eigen::Index>(3 * blocks.size());
  Eigen::MatrixXd result(size, size);
  for (Eigen::Index j = 0; j < size; j += 3) {
    const auto first = static_cast<Eigen::Index>(3 * blocks[static_cast<std::size_t>(j / 3)]);
    const Eigen::MatrixX3d columns =
        dense ? Eigen::MatrixX3d(dense->middleCols<3>(first)) : columns_of_inverse(ldlt, first);
    for (Eigen::Index i = 0; i < size; i += 3) {
      result.block<3, 3>(i, j) = columns.middleRows<3>(
          static_cast<Eigen::Index>(3 * blocks[static_cast<std::size_t>(i / 3)]));
    }
  }
  return result;
}

}  // namespace fathom
