#include "roadstereo/road_map.hpp"

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

}  // namespace roadstereo
