#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo::test {

/// A number in [0, 1) from a lattice point: the same on every machine.
inline double lattice(std::int64_t x, std::int64_t y, std::uint64_t seed) {
  std::uint64_t h = seed * 0x9E3779B97F4A7C15ULL ^ static_cast<std::uint64_t>(x) * 0xBF58476D1CE4E5B9ULL ^
                    static_cast<std::uint64_t>(y) * 0x94D049BB133111EBULL;
  h ^= h >> 31;
  h *= 0xD6E8FEB86659FD93ULL;
  h ^= h >> 32;
  h *= 0xD6E8FEB86659FD93ULL;
  h ^= h >> 29;
  return static_cast<double>(h >> 11) * 0x1.0p-53;
}

/// Smooth noise in [0, 1], features about `size` pixels across.
inline double smooth_noise(double x, double y, double size, std::uint64_t seed) {
  const double gx = std::floor(x / size), gy = std::floor(y / size);
  const double fx = x / size - gx, fy = y / size - gy;
  const double sx = fx * fx * (3 - 2 * fx), sy = fy * fy * (3 - 2 * fy);
  const auto ix = static_cast<std::int64_t>(gx), iy = static_cast<std::int64_t>(gy);
  const double top = lattice(ix, iy, seed) * (1 - sx) + lattice(ix + 1, iy, seed) * sx;
  const double bottom = lattice(ix, iy + 1, seed) * (1 - sx) + lattice(ix + 1, iy + 1, seed) * sx;
  return top * (1 - sy) + bottom * sy;
}

/// A pair painted with smooth noise: target pixel (x, v) shows what reference pixel (u, v), x = u − d(u, v), shows.
/// `disparity` must change slowly along u.
struct TexturedPair {
  GreyImage reference;
  GreyImage target;
};

inline TexturedPair textured_pair(int width, int height, const std::function<double(double, double)>& disparity,
                                  std::uint64_t seed = 1, double contrast = 1) {
  TexturedPair pair{GreyImage(width, height), GreyImage(width, height)};
  const auto grey = [&](double u, double v) {
    const double value = 0.5 * smooth_noise(u, v, 3.1, seed) + 0.3 * smooth_noise(u, v, 7.3, seed + 1) +
                         0.2 * smooth_noise(u, v, 23, seed + 2);
    return static_cast<std::int16_t>(std::lround((0.5 + contrast * (value - 0.5)) * grey_max));
  };
  for (int v = 0; v < height; ++v) {
    for (int x = 0; x < width; ++x) {
      pair.reference(x, v) = grey(x, v);
      double u = x;  // solves u − d(u, v) = x
      for (int i = 0; i < 40; ++i) u = x + disparity(u, v);
      pair.target(x, v) = grey(u, v);
    }
  }
  return pair;
}

}  // namespace roadstereo::test
