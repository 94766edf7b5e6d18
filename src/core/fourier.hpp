#pragma once

#include <array>
#include <cstddef>

namespace roadstereo {

/// Discrete Fourier transform of squares of `side`×`side` complex values.
class FourierSquare {
 public:
  static constexpr int side = 64;

  FourierSquare();

  float* real_row(int v) { return real_[static_cast<std::size_t>(v)].data(); }
  float* imaginary_row(int v) { return imaginary_[static_cast<std::size_t>(v)].data(); }

  /// Transforms the square, in place and transposed: row k has the frequency k along the rows, or k − side, and column
  /// l the frequency l along the columns.
  void transform();

 private:
  /// Every column at once (Cooley–Tukey, radix 2): consecutive columns are consecutive in memory.
  void transform_columns();
  void transpose();

  std::array<float, side / 2> cosines_, sines_;
  std::array<std::array<float, side>, side> real_, imaginary_;
};

}  // namespace roadstereo
