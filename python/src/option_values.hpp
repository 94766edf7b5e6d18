#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "roadstereo/pipeline.hpp"

namespace roadstereo::python {

/// Sets options by the keys of `--set`, from a mapping or None, then from keywords. Throws Error for an unknown key or
/// a bad value, pybind11::type_error for a value that is neither a bool, a number nor a str.
void set_options(PipelineOptions& options, const pybind11::object& values, const pybind11::kwargs& keywords);

/// The same of options of the search for damage only, and with `with_threads` of `threads`; others raise Error.
void set_damage_options(PipelineOptions& options, const pybind11::object& values, const pybind11::kwargs& keywords,
                        bool with_threads);

/// Returns every option by its key, as bool, int, float or str.
pybind11::dict option_values(const PipelineOptions& options);

}  // namespace roadstereo::python
