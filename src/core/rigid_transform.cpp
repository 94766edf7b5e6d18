#include "roadstereo/rigid_transform.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace roadstereo {

RigidTransform compose(const RigidTransform& second, const RigidTransform& first) {
  RigidTransform product{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      double sum = column == 3 ? second[4 * row + 3] : 0;
      for (std::size_t k = 0; k < 3; ++k) sum += second[4 * row + k] * first[4 * k + column];
      product[4 * row + column] = sum;
    }
  }
  return product;
}

RigidTransform inverse(const RigidTransform& transform) {
  RigidTransform result{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      result[4 * row + column] = transform[4 * column + row];
      result[4 * row + 3] -= transform[4 * column + row] * transform[4 * column + 3];
    }
  }
  return result;
}

double rotation_error(const RigidTransform& t) {
  double error = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double product = t[i] * t[j] + t[4 + i] * t[4 + j] + t[8 + i] * t[8 + j];
      error = std::max(error, std::abs(product - (i == j ? 1 : 0)));
    }
  }
  return error;
}

double determinant(const RigidTransform& t) {
  return t[0] * (t[5] * t[10] - t[6] * t[9]) - t[1] * (t[4] * t[10] - t[6] * t[8]) + t[2] * (t[4] * t[9] - t[5] * t[8]);
}

std::array<double, 3> rotate(const RigidTransform& t, const std::array<double, 3>& d) {
  return {t[0] * d[0] + t[1] * d[1] + t[2] * d[2], t[4] * d[0] + t[5] * d[1] + t[6] * d[2],
          t[8] * d[0] + t[9] * d[1] + t[10] * d[2]};
}

std::array<double, 3> transform_point(const RigidTransform& t, const std::array<double, 3>& p) {
  return {t[0] * p[0] + t[1] * p[1] + t[2] * p[2] + t[3], t[4] * p[0] + t[5] * p[1] + t[6] * p[2] + t[7],
          t[8] * p[0] + t[9] * p[1] + t[10] * p[2] + t[11]};
}

}  // namespace roadstereo
