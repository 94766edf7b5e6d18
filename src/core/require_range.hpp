#pragma once

#include "roadstereo/error.hpp"

namespace roadstereo {

/// Throws Error naming the option `group.name`, its value and its limits unless lowest ≤ value ≤ highest.
template <class Value>
void require_range(const char* group, const char* name, Value value, Value lowest, Value highest) {
  if (!(value >= lowest && value <= highest)) {
    fail(group, ".", name, " is ", value, "; it must be between ", lowest, " and ", highest);
  }
}

}  // namespace roadstereo
