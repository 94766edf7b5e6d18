#pragma once

#include <cstdint>
#include <vector>

#include "roadstereo/coarse_search.hpp"
#include "roadstereo/image.hpp"
#include "stereo/coarse/block_uncertainty.hpp"

namespace roadstereo {

struct TextureUncertaintyOptions {
  int block_radius;
  double noise;                 ///< standard deviation of a pixel, grey levels
  double row_offset_sigma_px;   ///< standard error of the vertical misalignment that is left
  double half_weight_sigma_px;  ///< standard error of the disparity at uncertainty ½
};

/// Those of the coarse search.
inline TextureUncertaintyOptions texture_uncertainty_options(const CoarseSearchOptions& options) {
  return {.block_radius = options.block_radius,
          .noise = options.ncc_noise_sigma,
          .row_offset_sigma_px = options.row_offset_sigma_px,
          .half_weight_sigma_px = options.half_weight_sigma_px};
}

/// Converts the options to parameters of the formula.
inline UncertaintyParams uncertainty_params(const TextureUncertaintyOptions& options) {
  constexpr double gradient_unit = 2.0 * grey_scale / (1 << CoarseGradient::shift);
  return {static_cast<float>(options.noise * options.noise * gradient_unit * gradient_unit),
          static_cast<float>(options.row_offset_sigma_px * options.row_offset_sigma_px),
          static_cast<float>(options.half_weight_sigma_px * options.half_weight_sigma_px)};
}

/// Texture uncertainty of the blocks of an image, from the structure tensor, in [0, 1]: 0 well constrained, 1
/// unconstrained. The standard error s of the disparity of a block is s² = noise² / Σ gu² + row_error² · (Σ gu gv /
/// Σ gu²)²: blocks without texture are unconstrained, and along an edge nearly parallel to the rows a small offset of
/// the rows looks like a large disparity. The uncertainty is s² / (s² + half_weight_sigma²).
class TextureUncertainty {
 public:
  /// Allocates memory for images of this width.
  void prepare(int columns);
  /// Begins at row `first_row` of the image; `next` is then called for that row and those below it.
  void start(ImageView<const std::int16_t> image, int first_row, const TextureUncertaintyOptions& options);
  /// Returns the uncertainty of the blocks of the next row; valid until the next call.
  const std::vector<float>& next();

 private:
  void add_row(int v, int sign);

  ImageView<const std::int16_t> image_;
  TextureUncertaintyOptions options_;
  int row_ = 0;
  std::vector<std::int32_t> squares_, products_;  ///< per column: Σ gu², Σ gu gv over the rows of a block
  std::vector<std::int32_t> window_squares_, window_products_;  ///< the same over the blocks
  std::vector<float> texture_uncertainty_;
};

}  // namespace roadstereo
