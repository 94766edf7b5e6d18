#include "roadstereo/damage.hpp"

namespace roadstereo {

const char* name_of(DamageKind kind) {
  return kind == DamageKind::depression ? "depression" : "protrusion";
}

const char* name_of(Severity severity) {
  switch (severity) {
    case Severity::unknown:
      return "unknown";
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
  }
  return "unknown";
}

Severity astm_severity(double depth_m, double diameter_m) {
  constexpr double least_depth_m = 0.013;
  constexpr double medium_depth_m = 0.025;
  constexpr double high_depth_m = 0.050;
  constexpr double least_diameter_m = 0.100;
  constexpr double medium_diameter_m = 0.200;
  constexpr double high_diameter_m = 0.450;
  if (depth_m < least_depth_m || diameter_m < least_diameter_m) return Severity::minor;
  // Rows: depth; columns: diameter. Wider than the table's 750 mm counts as its last column.
  constexpr Severity table[3][3] = {{Severity::low, Severity::low, Severity::medium},
                                    {Severity::low, Severity::medium, Severity::high},
                                    {Severity::medium, Severity::medium, Severity::high}};
  const int row = depth_m < medium_depth_m ? 0 : depth_m <= high_depth_m ? 1 : 2;
  const int column = diameter_m < medium_diameter_m ? 0 : diameter_m < high_diameter_m ? 1 : 2;
  return table[row][column];
}

}  // namespace roadstereo
