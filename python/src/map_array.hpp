#pragma once

#include <pybind11/numpy.h>

#include "roadstereo/image.hpp"

namespace roadstereo::python {

/// Returns a read-only array (H, W) of the map's own pixels, which keeps `owner` alive.
template <class T>
pybind11::array_t<T> map_array(const Image<T>& map, const pybind11::object& owner) {
  const pybind11::array_t<T> array({map.height(), map.width()}, map.row(0), owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

}  // namespace roadstereo::python
