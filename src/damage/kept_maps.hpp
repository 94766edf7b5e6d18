#pragma once

#include <vector>

#include "roadstereo/image.hpp"

namespace roadstereo {

/// Memory for the maps and lists that every frame makes and drops. What is freed is kept for those of the next frame:
/// the system takes about as long to give new pages as it takes to fill them. All threads share it.
ImageMemory& kept_memory();

/// Returns a map in kept memory. Pixels are unspecified.
template <class T>
Image<T> kept_map(int width, int height) {
  Image<T> map(kept_memory());
  map.resize(width, height);
  return map;
}

/// The same with every pixel `value`.
template <class T>
Image<T> kept_map(int width, int height, T value) {
  Image<T> map(kept_memory());
  map.assign(width, height, value);
  return map;
}

/// List in kept memory: `KeptList<T> list = kept_list<T>();`
template <class T>
using KeptList = std::vector<T, ImageAllocator<T>>;

template <class T>
KeptList<T> kept_list(std::size_t size = 0, const T& value = T{}) {
  return KeptList<T>(size, value, ImageAllocator<T>(&kept_memory()));
}

}  // namespace roadstereo
