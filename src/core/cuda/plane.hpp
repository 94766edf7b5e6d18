#pragma once

#include <cstddef>

#include "core/cuda/host_device.hpp"

namespace roadstereo::cuda {

/// A rectangle of pixels in device memory that somebody else owns, row by row; `stride` counts elements.
template <class T>
struct Plane {
  T* data = nullptr;
  int width = 0;
  int height = 0;
  std::ptrdiff_t stride = 0;

  ROADSTEREO_HD T* row(int v) const { return data + v * stride; }
  ROADSTEREO_HD T& operator()(int u, int v) const { return row(v)[u]; }
  ROADSTEREO_HD operator Plane<const T>() const { return {data, width, height, stride}; }
};

/// A plane without padding between its rows.
template <class T>
Plane<T> packed_plane(T* data, int width, int height) {
  return {data, width, height, width};
}

}  // namespace roadstereo::cuda
