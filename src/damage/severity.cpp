#include <array>

#include "roadstereo/damage.hpp"

namespace roadstereo {

const char* name_of(DamageKind kind) {
  return kind == DamageKind::depression ? "depression" : "protrusion";
}

const char* name_of(Severity severity) {
  switch (severity) {
    case Severity::unresolvable:
      return "unresolvable";
    case Severity::minor:
      return "minor";
    case Severity::low:
      return "low";
    case Severity::medium:
      return "medium";
    case Severity::high:
      return "high";
    case Severity::unknown:
      break;
  }
  return "unknown";
}

Severity astm_severity(double depth_m, double diameter_m) {
  constexpr double min_depth_m = 0.013, min_diameter_m = 0.1;
  constexpr std::array<double, 2> depths_m{0.025, 0.050}, diameters_m{0.2, 0.45};
  using enum Severity;
  constexpr std::array<std::array<Severity, 3>, 3> table{
      {{low, low, medium}, {low, medium, high}, {medium, medium, high}}};
  if (!(depth_m >= min_depth_m) || !(diameter_m >= min_diameter_m)) return minor;
  const std::size_t row = depth_m > depths_m[1] ? 2 : depth_m > depths_m[0] ? 1 : 0;
  const std::size_t column = diameter_m > diameters_m[1] ? 2 : diameter_m > diameters_m[0] ? 1 : 0;
  return table[row][column];
}

}  // namespace roadstereo
