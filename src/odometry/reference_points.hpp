#pragma once

#include <array>
#include <vector>

#include "odometry/image_pyramid.hpp"
#include "odometry/rigid_motion.hpp"
#include "roadstereo/calibration.hpp"
#include "roadstereo/image_view.hpp"

namespace roadstereo {

/// Pixel of a frame whose depth is known.
struct ReferencePoint {
  double u = 0, v = 0;     ///< of the image, pixels
  double disparity = 0;    ///< as measured, pixels
  double sigma_px = 0;     ///< standard error of the disparity
  double grey = 0;         ///< 8-bit grey levels, of the level of the pyramid
  double slope_u = 0;      ///< of the disparity around the pixel, pixels per column
  double slope_v = 0;      ///< pixels per row
  bool has_slope = false;  ///< false at the border of a surface
  int cell = 0;            ///< of the image: points of one cell have correlated errors
};

/// Square of pixels of one level of the pyramid around a point, with a margin so that it can be warped.
struct TexturePatch {
  static constexpr int radius = 5;
  static constexpr int side = 2 * radius + 1;
  ReferencePoint point;
  std::array<float, std::size_t{side} * side> grey{};
  /// Structure tensor: sums of the products of the gradients, of trace 1. Small across what the patch cannot locate.
  double uu = 0, uv = 0, vv = 0;
};

/// What a frame keeps to align later ones with it.
struct ReferencePoints {
  std::vector<std::vector<ReferencePoint>> levels;  ///< of the pyramid
  std::vector<std::vector<TexturePatch>> patches;   ///< of the levels from 1
  int cells = 0;
};

inline constexpr double max_jump_px = 1;  ///< between neighbouring disparities of one surface

/// What links need of a frame, W×H.
struct LinkMaps {
  const ImagePyramid& pyramid;
  ImageView<const float> disparity;  ///< pixels, NaN invalid
  ImageView<const float> sigma;      ///< standard error, pixels
  double disparity_offset_px = 0;    ///< of the calibration: no depth where disparity + offset is 0 or less
};

/// Selects the pixel with the largest gradient of every cell of a grid that has a disparity, per level of the pyramid,
/// and patches of texture that verify an alignment.
void select_points(const LinkMaps& frame, ReferencePoints& points);

}  // namespace roadstereo
