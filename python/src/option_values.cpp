#include "option_values.hpp"

#include "roadstereo/error.hpp"
#include "roadstereo/options.hpp"
#include "type_name.hpp"

namespace roadstereo::python {
namespace {

namespace py = pybind11;

bool is_bool(py::handle value) {
  py::detail::make_caster<bool> caster;
  return caster.load(value, false);  // numpy's too
}

/// Returns the value as `--set` spells it; numbers are read back exactly.
std::string option_text(const std::string& key, py::handle value) {
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (is_bool(value)) return value.cast<bool>() ? "true" : "false";
  const auto object = py::reinterpret_borrow<py::object>(value);
  if (const auto whole = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()))) return py::str(whole);
  PyErr_Clear();  // of an array of one number, too, which claims to be whole
  if (py::hasattr(value, "__float__")) return py::repr(py::float_(py::float_(object).cast<double>()));
  throw py::type_error("the option '" + key + "' is of type " + type_name(value) +
                       "; it must be a bool, a number or a str");
}

void set_each(PipelineOptions& options, const py::dict& values) {
  for (const auto& [key, value] : values) {
    const auto name = py::str(key).cast<std::string>();
    set_option(options, name, option_text(name, value));
  }
}

py::object parsed(const OptionText& option) {
  switch (option.kind) {
    case OptionKind::boolean:
      return py::bool_(option.value == "true");
    case OptionKind::whole:
      return py::int_(py::str(option.value));
    case OptionKind::real:
      return py::float_(py::str(option.value));
    case OptionKind::word:
      break;
  }
  return py::str(option.value);
}

}  // namespace

void set_options(PipelineOptions& options, const py::object& values, const py::kwargs& keywords) {
  if (!values.is_none()) set_each(options, py::dict(values));
  set_each(options, keywords);
}

void set_damage_options(PipelineOptions& options, const py::object& values, const py::kwargs& keywords,
                        bool with_threads) {
  const py::dict positional = values.is_none() ? py::dict() : py::dict(values);
  for (const py::dict& part : {positional, py::dict(keywords)}) {
    for (const auto& [key, value] : part) {
      const auto name = py::str(key).cast<std::string>();
      if (name.starts_with("damage.") || (with_threads && name == "threads")) continue;
      fail("\"", name, "\" has no effect here; find_damage accepts keys that start with damage.",
           with_threads ? ", and threads" : "");
    }
  }
  set_options(options, values, keywords);
}

py::dict option_values(const PipelineOptions& options) {
  py::dict values;
  for (const OptionText& option : list_options(options)) values[py::str(option.key)] = parsed(option);
  return values;
}

}  // namespace roadstereo::python
