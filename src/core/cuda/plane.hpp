#pragma once

#include <cstddef>
#include <type_traits>

#include "core/cuda/host_device.hpp"

namespace roadstereo::cuda {

/// A rectangle of pixels in device memory that somebody else owns, row by row; `stride` counts elements. A plane for
/// writing is also one for reading.
template <class T>
struct Plane {
  Plane() = default;
  ROADSTEREO_HD Plane(T* pixels, int columns, int rows, std::ptrdiff_t elements)
      : data(pixels), width(columns), height(rows), stride(elements) {}
  template <class Writable, class = std::enable_if_t<std::is_same_v<const Writable, T>>>
  ROADSTEREO_HD Plane(const Plane<Writable>& plane) : Plane(plane.data, plane.width, plane.height, plane.stride) {}

  T* data = nullptr;
  int width = 0;
  int height = 0;
  std::ptrdiff_t stride = 0;

  ROADSTEREO_HD T* row(int v) const { return data + v * stride; }
  ROADSTEREO_HD T& operator()(int u, int v) const { return row(v)[u]; }
};

/// A plane without padding between its rows.
template <class T>
Plane<T> packed_plane(T* data, int width, int height) {
  return {data, width, height, width};
}

}  // namespace roadstereo::cuda
