#pragma once

#include "core/cholesky.hpp"
#include "odometry/alignment_equations.hpp"

namespace roadstereo {

/// Normal equations of an alignment.
struct NormalEquations {
  static constexpr double smallest = 1e-12;  ///< of a diagonal element: rounding

  Matrix<unknowns> matrix{};
  Vector<unknowns> right{};

  /// Adds sums of `add_products`.
  void add(const Matrix<unknowns + 1>& products) {
    for (std::size_t i = 0; i < unknowns; ++i) {
      right[i] -= products[unknowns][i];
      for (std::size_t j = 0; j <= i; ++j) matrix[i][j] += products[i][j];
    }
  }

  /// An unknown is expected to be `excess` smaller, with a standard deviation; 0: it stays as it is.
  void expect(std::size_t index, double excess, double sd) {
    if (sd > 0) {
      matrix[index][index] += 1 / (sd * sd);
      right[index] -= excess / (sd * sd);
      return;
    }
    for (std::size_t j = 0; j < index; ++j) matrix[index][j] = 0;
    for (std::size_t i = index + 1; i < unknowns; ++i) matrix[i][index] = 0;
    matrix[index][index] = 1;
    right[index] = 0;
  }

  Vector<unknowns> solved() const {
    Matrix<unknowns> factor = matrix;
    factor_in_place(factor, smallest);
    return solve_factored(factor, right);
  }
};

}  // namespace roadstereo
