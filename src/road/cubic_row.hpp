#pragma once

#include <cstdint>

// Cubic interpolation along a row of an image, with vector instructions.

namespace roadstereo {

/// out[x] = what lies at row[x] + f(x) for x in [first, end), 0 ≤ f < 1: `f_at_first` + (x − first)·`f_step`. Reads one
/// pixel before and two behind.
void sample_cubic(const float* row, float f_at_first, float f_step, int first, int end, std::int16_t* out);

}  // namespace roadstereo
