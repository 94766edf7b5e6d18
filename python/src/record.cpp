#include "record.hpp"

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

}  // namespace roadstereo::python
