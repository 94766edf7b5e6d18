#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace roadstereo::python {

/// Returns "Name(attribute=value, …)".
std::string attributes_text(const pybind11::object& object, const std::vector<const char*>& attributes);

/// Makes `text`, a function of an object, the repr of its class. A method of pybind11 has no hash, which pprint needs:
/// a function of Python stands in for it.
void set_repr(pybind11::handle type, const pybind11::cpp_function& text);

/// Declares a class of read-only attributes. Its repr lists them.
template <class Value>
class Record {
 public:
  Record(pybind11::module_& module, const char* name, const char* doc) : class_(module, name, doc) {
    set_repr(class_,
             [attributes = attributes_](const pybind11::object& self) { return attributes_text(self, *attributes); });
  }

  /// Adds an attribute: a data member, or a function of the value.
  template <class Getter>
  Record& field(const char* name, Getter getter, const char* doc) {
    if constexpr (std::is_member_object_pointer_v<Getter>) {
      class_.def_readonly(name, getter, doc);
    } else {
      class_.def_property_readonly(name, getter, doc);
    }
    attributes_->push_back(name);
    return *this;
  }

  pybind11::class_<Value>& type() { return class_; }

 private:
  std::shared_ptr<std::vector<const char*>> attributes_ = std::make_shared<std::vector<const char*>>();
  pybind11::class_<Value> class_;
};

}  // namespace roadstereo::python
