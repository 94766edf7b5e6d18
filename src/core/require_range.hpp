#pragma once

#include <limits>

#include "roadstereo/error.hpp"

namespace roadstereo {

/// Limit of require_range that the value must exceed.
template <class Value>
struct Above {
  Value limit;
};
template <class Value>
Above(Value) -> Above<Value>;

/// Highest or lowest value of a range without a limit.
inline constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Throws Error naming the option `group.name`, its value and its limits unless lowest ≤ value ≤ highest; NaN is in no
/// range.
template <class Value>
void require_range(const char* group, const char* name, Value value, Value lowest, Value highest) {
  if (value >= lowest && value <= highest) return;
  if (highest == unlimited) fail(group, ".", name, " is ", value, "; it must be at least ", lowest);
  if (lowest == -unlimited) fail(group, ".", name, " is ", value, "; it must be at most ", highest);
  fail(group, ".", name, " is ", value, "; it must be between ", lowest, " and ", highest);
}

/// The same unless lowest < value ≤ highest.
template <class Value>
void require_range(const char* group, const char* name, Value value, Above<Value> lowest, Value highest) {
  if (value > lowest.limit && value <= highest) return;
  if (highest == unlimited) fail(group, ".", name, " is ", value, "; it must be above ", lowest.limit);
  fail(group, ".", name, " is ", value, "; it must be above ", lowest.limit, " and at most ", highest);
}

}  // namespace roadstereo
