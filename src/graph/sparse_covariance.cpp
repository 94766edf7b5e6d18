#include "graph/sparse_covariance.hpp"

#include <algorithm>
#include <utility>

#include "roadstereo/error.hpp"

namespace roadstereo {

SparseCovariance::SparseCovariance(const Eigen::SparseMatrix<double>& information) : factor_(information) {
  if (factor_.info() != Eigen::Success || !(factor_.vectorD().minCoeff() > 0)) {
    fail("the pose graph is not determined: its information matrix is singular");
  }
}

double SparseCovariance::element(int i, int j) const {
  if (i == j) return diagonal_[static_cast<std::size_t>(i)];
  const auto [column, row] = std::minmax(i, j);
  const int* const rows = lower_.innerIndexPtr();
  const int* const last = rows + lower_.outerIndexPtr()[column + 1];
  const int* const found = std::lower_bound(rows + lower_.outerIndexPtr()[column], last, row);
  return found != last && *found == row ? inverse_[static_cast<std::size_t>(found - rows)] : 0;
}

/// Z_ij = −Σ L_kj Z_ik over k > j, and Z_jj = 1/D_jj − Σ L_kj Z_kj, from the last column to the first.
void SparseCovariance::fill() {
  lower_ = Eigen::SparseMatrix<double>(factor_.matrixL()).triangularView<Eigen::StrictlyLower>();
  lower_.makeCompressed();
  const auto size = static_cast<std::size_t>(lower_.cols());
  diagonal_.assign(size, 0);
  inverse_.assign(static_cast<std::size_t>(lower_.nonZeros()), 0);
  const int* const rows = lower_.innerIndexPtr();
  const double* const values = lower_.valuePtr();
  const Eigen::VectorXd pivots = factor_.vectorD();
  for (auto j = static_cast<int>(size) - 1; j >= 0; --j) {
    const int begin = lower_.outerIndexPtr()[j], end = lower_.outerIndexPtr()[j + 1];
    double diagonal = 1 / pivots[j];
    for (int i = end - 1; i >= begin; --i) {
      double sum = 0;
      for (int k = begin; k < end; ++k) sum -= values[k] * element(rows[i], rows[k]);
      inverse_[static_cast<std::size_t>(i)] = sum;
      diagonal -= values[i] * sum;
    }
    diagonal_[static_cast<std::size_t>(j)] = diagonal;
  }
}

Eigen::MatrixXd SparseCovariance::block(int first, int size) {
  if (diagonal_.empty()) fill();
  const auto& order = factor_.permutationP().indices();
  Eigen::MatrixXd result(size, size);
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) result(i, j) = element(order[first + i], order[first + j]);
  }
  return result;
}

Eigen::MatrixXd SparseCovariance::of(const Eigen::SparseMatrix<double>& jacobian) const {
  const Eigen::MatrixXd rows = Eigen::MatrixXd(jacobian).transpose();
  return rows.transpose() * factor_.solve(rows);
}

}  // namespace roadstereo
