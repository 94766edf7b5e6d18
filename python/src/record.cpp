#include "record.hpp"

#include <pybind11/eval.h>

#include "type_name.hpp"

namespace roadstereo::python {

std::string attributes_text(const pybind11::object& object, const std::vector<const char*>& attributes) {
  std::string text;
  for (const char* name : attributes) {
    text +=
        (text.empty() ? "" : ", ") + std::string(name) + "=" + pybind11::repr(object.attr(name)).cast<std::string>();
  }
  return type_name(object) + "(" + text + ")";
}

void set_repr(pybind11::handle type, const pybind11::cpp_function& text) {
  type.attr("__repr__") = pybind11::eval("lambda text: lambda self: text(self)")(text);
}

}  // namespace roadstereo::python
