#pragma once

#include <cstdint>

#include "roadstereo/image_view.hpp"
#include "roadstereo/perspective_shift.hpp"

// C++17, for kernels.

#pragma GCC visibility push(default)
namespace roadstereo {

/// A stereo pair after the perspective transformation of the target.
struct TransformedPair {
  ImageView<const std::int16_t> reference, target;
  const int* first_column = nullptr;  ///< of each row of the target that is not empty; nullptr: 0
  PerspectiveShift shift;
  ImageView<const std::uint8_t> mask{};  ///< of the reference, not 0 masked; empty: none
};

}  // namespace roadstereo
#pragma GCC visibility pop
