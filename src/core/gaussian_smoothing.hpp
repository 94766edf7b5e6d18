#pragma once

#include <cstdint>

#include "roadstereo/host_device.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo {

/// Weights of the discrete Gaussian, whose variance is exact however small it is (Lindeberg, "Scale-space for discrete
/// signals", 1990), in fractions of 2^14, so that a host and a device have the same bits.
struct SmoothingKernel {
  static constexpr int max_radius = 20, fraction_bits = 14;

  int radius = 0;
  std::int16_t weights[max_radius + 1] = {
      1 << fraction_bits};  ///< of the pixel, and of those so far on either side of it
};

/// `variance_px2`: 0 … 16 pixels².
SmoothingKernel smoothing_kernel(double variance_px2);

/// Weighted sum over the pixels `at(-radius)` … `at(radius)` of a row or a column.
template <class At>
ROADSTEREO_HD std::int16_t smoothed_level(const SmoothingKernel& kernel, At at) {
  int sum = (1 << (SmoothingKernel::fraction_bits - 1)) + kernel.weights[0] * at(0);
  for (int k = 1; k <= kernel.radius; ++k) sum += kernel.weights[k] * (at(-k) + at(k));
  return static_cast<std::int16_t>(sum >> SmoothingKernel::fraction_bits);
}

/// Column or row of an image, the nearest one for those beyond its border.
ROADSTEREO_HD inline int clamped_index(int index, int size) {
  return index < 0 ? 0 : index < size ? index : size - 1;
}

/// Smooths `image` along its rows, then along its columns; `between` is scratch memory of its size.
void smooth_image(const SmoothingKernel& kernel, int threads, ImageView<std::int16_t> image,
                  ImageView<std::int16_t> between);

}  // namespace roadstereo
