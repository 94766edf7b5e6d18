#pragma once

#include <array>

#include "roadstereo/damage.hpp"

namespace roadstereo::io {

using Rgb = std::array<int, 3>;

/// Returns the colour of a damage in overlays and reports: by severity, or by kind if the severity is unknown.
inline Rgb damage_colour(DamageKind kind, Severity severity) {
  switch (severity) {
    case Severity::high:
      return {214, 39, 40};
    case Severity::medium:
      return {242, 122, 24};
    case Severity::low:
      return {240, 190, 30};
    case Severity::minor:
      return {70, 170, 120};
    case Severity::uncertain:
      return {120, 130, 200};
    case Severity::unresolvable:
      return {150, 150, 155};
    case Severity::unknown:
      break;
  }
  return kind == DamageKind::depression ? Rgb{225, 70, 70} : Rgb{60, 130, 210};
}

inline Severity severity_of(const Damage& damage) {
  return damage.metrics ? damage.metrics->severity : Severity::unknown;
}

inline Distress distress_of(const Damage& damage) {
  return damage.metrics ? damage.metrics->distress : Distress::unknown;
}

}  // namespace roadstereo::io
