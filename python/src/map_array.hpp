#pragma once

#include <pybind11/numpy.h>

#include <array>

#include "roadstereo/image.hpp"

namespace roadstereo::python {

/// Returns a read-only array (H, W) of the map's own pixels, which keeps `owner` alive.
template <class T>
pybind11::array_t<T> map_array(const Image<T>& map, const pybind11::object& owner) {
  const pybind11::array_t<T> array({map.height(), map.width()}, map.row(0), owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// Returns an array (rows, columns) of a matrix, a copy.
template <int rows, int columns>
pybind11::array_t<double> matrix(const std::array<double, rows * columns>& values) {
  return pybind11::array_t<double>({rows, columns}, values.data());
}

}  // namespace roadstereo::python
