#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <vector>

namespace roadstereo {

/// Elements of the inverse of a sparse information matrix: those of its own pattern by Takahashi's equations, others by
/// solving with the factor L D Lᵀ (fill-reducing order, one thread).
class SparseCovariance {
 public:
  /// Throws Error if the matrix is not positive definite: something is not determined.
  explicit SparseCovariance(const Eigen::SparseMatrix<double>& information);

  Eigen::Index size() const { return factor_.rows(); }

  /// Elements (i, j) of the inverse for i and j from `first` to `first + size` whose elements of the matrix are not
  /// structurally 0.
  Eigen::MatrixXd block(int first, int size);

  /// Covariance of J·x for a matrix of few rows.
  Eigen::MatrixXd of(const Eigen::SparseMatrix<double>& jacobian) const;

 private:
  void fill();
  double element(int i, int j) const;

  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  Eigen::SparseMatrix<double> lower_;  ///< strictly lower part of L
  std::vector<double> inverse_;        ///< elements of the inverse where L has some
  std::vector<double> diagonal_;       ///< empty: not yet computed
};

}  // namespace roadstereo
