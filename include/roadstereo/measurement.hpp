#pragma once

#pragma GCC visibility push(default)
namespace roadstereo {

/// Number of its standard errors that a value must have to be resolvable.
inline constexpr double min_resolved_sigmas = 3;

/// A measured value with its standard error.
struct Measurement {
  double value = 0;
  double std_error = 0;

  /// Whether the value is at least three standard errors.
  bool is_resolved() const { return value >= min_resolved_sigmas * std_error; }
};

}  // namespace roadstereo
#pragma GCC visibility pop
