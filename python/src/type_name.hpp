#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace roadstereo::python {

/// Returns the name of the class of an object, for messages.
inline std::string type_name(pybind11::handle object) {
  return pybind11::str(pybind11::type::handle_of(object).attr("__name__"));
}

}  // namespace roadstereo::python
