#pragma once

#include "road/shift_terms.hpp"
#include "roadstereo/perspective.hpp"

namespace roadstereo {

/// The road as kernels take it.
inline PlaneTerms plane_terms(const DisparityPlane& road) {
  return {road.a0, road.a1, road.a2};
}

/// The shift as kernels take it.
inline ShiftTerms shift_terms(const PerspectiveShift& shift) {
  return {plane_terms(shift.road), shift.delta_p, shift.row_offset, shift.whole_pixel, shift.enabled};
}

}  // namespace roadstereo
