#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace roadstereo {

template <std::size_t N>
using Vector = std::array<double, N>;
/// Row after row.
template <std::size_t N>
using Matrix = std::array<Vector<N>, N>;

/// Puts the Cholesky factor of a symmetric positive semidefinite matrix into its lower half, which alone is read. A row
/// is a combination of those before it when no more than `smallest` of its diagonal element is left, which is what
/// rounding leaves of nothing: it becomes 0. Returns how many do.
template <std::size_t N>
std::size_t factor_in_place(Matrix<N>& a, double smallest) {
  std::size_t dependent = 0;
  for (std::size_t k = 0; k < N; ++k) {
    const double size = a[k][k];
    for (std::size_t j = 0; j < k; ++j) a[k][k] -= a[k][j] * a[k][j];
    const bool independent = a[k][k] > smallest * size;
    if (!independent) {
      ++dependent;
      a[k] = {};
    }
    a[k][k] = independent ? std::sqrt(a[k][k]) : 0;
    for (std::size_t i = k + 1; i < N; ++i) {
      for (std::size_t j = 0; j < k; ++j) a[i][k] -= a[i][j] * a[k][j];
      a[i][k] = independent ? a[i][k] / a[k][k] : 0;
    }
  }
  return dependent;
}

/// Solves a x = b for the factor of a. x is 0 in rows that depend on others.
template <std::size_t N>
Vector<N> solve_factored(const Matrix<N>& factor, Vector<N> b) {
  for (std::size_t k = 0; k < N; ++k) {
    for (std::size_t j = 0; j < k; ++j) b[k] -= factor[k][j] * b[j];
    b[k] = factor[k][k] > 0 ? b[k] / factor[k][k] : 0;
  }
  for (std::size_t k = N; k-- > 0;) {
    for (std::size_t i = k + 1; i < N; ++i) b[k] -= factor[i][k] * b[i];
    b[k] = factor[k][k] > 0 ? b[k] / factor[k][k] : 0;
  }
  return b;
}

/// Solves a x = b for a symmetric matrix; nothing when it is not positive definite up to `smallest`.
template <std::size_t N>
std::optional<Vector<N>> solve_positive_definite(Matrix<N> a, const Vector<N>& b, double smallest) {
  if (factor_in_place(a, smallest) > 0) return std::nullopt;
  return solve_factored(a, b);
}

}  // namespace roadstereo
