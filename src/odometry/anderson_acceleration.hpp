#pragma once

#include <algorithm>
#include <cstddef>

#include "core/cholesky.hpp"

namespace roadstereo {

/// Anderson acceleration, depth 1, of steps that converge linearly, as those of reweighted least squares do: the step
/// that the last two say would end in 0 (Walker and Ni, 2011).
template <std::size_t N>
class AndersonAcceleration {
 public:
  /// Step to take instead of `step`, lengths in the norm of the lower half of `metric`.
  Vector<N> accelerated(const Vector<N>& step, const Matrix<N>& metric) {
    constexpr double least = -2, most = 0.5;  // steps that shrink to two thirds; that turn round
    Vector<N> taken = step;
    if (has_last_) {
      Vector<N> change{};
      for (std::size_t i = 0; i < N; ++i) change[i] = step[i] - last_step_[i];
      const double squared = product(metric, change, change);
      double share = squared > 0 ? product(metric, change, step) / squared : 0;
      share = share > 1 ? 0 : std::clamp(share, least, most);  // above 1 steps grow: they say nothing of an end
      for (std::size_t i = 0; i < N; ++i) taken[i] -= share * (last_taken_[i] + change[i]);
    }
    has_last_ = true;
    last_step_ = step;
    last_taken_ = taken;
    return taken;
  }

 private:
  static double product(const Matrix<N>& metric, const Vector<N>& a, const Vector<N>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < N; ++i) {
      sum += metric[i][i] * a[i] * b[i];
      for (std::size_t j = 0; j < i; ++j) sum += metric[i][j] * (a[i] * b[j] + a[j] * b[i]);
    }
    return sum;
  }

  bool has_last_ = false;
  Vector<N> last_step_{}, last_taken_{};
};

}  // namespace roadstereo
