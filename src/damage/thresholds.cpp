#include "damage/thresholds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadstereo/ground_plane.hpp"

namespace roadstereo {

Thresholds::Thresholds(const DamageInput& input, const DamageOptions& options, const Cells& cells,
                       const SurfaceCoordinates& coordinates, double noise, bool metric)
    : input_(input),
      options_(options),
      cells_(cells),
      scale_(coordinates.scale),
      metric_(metric),
      noise_(static_cast<float>(options.threshold_sigma * noise)),
      min_depth_m_(metric ? options.min_depth_m : 0) {
  if (metric) camera_height_m_ = ground_plane(*input.plane, *input.calibration).height_m;
}

void Thresholds::min_depths(int j, float* row) const {
  const float* const scale = scale_.row(j);
  const float noise = noise_;
  const double min_depth_m = min_depth_m_;
  const int width = scale_.width();
  for (int i = 0; i < width; ++i) row[i] = std::max(noise, static_cast<float>(min_depth_m * scale[i]));
}

float Thresholds::pixels_below(double depth_m, int i, int j) const {
  const double scale = scale_(i, j);
  const double distance_m = camera_height_m_ + depth_m;  // a point at a fixed pixel moves away by its share
  if (!metric_ || std::isnan(scale) || distance_m <= 0) {
    return std::copysign(std::numeric_limits<float>::infinity(), static_cast<float>(depth_m));
  }
  return static_cast<float>(depth_m * scale * camera_height_m_ / distance_m);
}

float Thresholds::min_cells(int i, int j) const {
  constexpr double min_pixels = 64;  // 8×8: what is smaller than the support window is noise
  if (!metric_ || std::isnan(scale_(i, j))) {
    return static_cast<float>(options_.min_area_share * static_cast<double>(cells_.value.pixels()));
  }
  const StereoCalibration& calibration = *input_.calibration;
  const double z = calibration.depth_m(input_.plane->disparity(cells_.middle(i), cells_.middle(j)));
  const double pixel_m2 = z * z * z / (calibration.focal_px * calibration.focal_px * camera_height_m_);
  const double cells_per_pixel = 1.0 / (cells_.factor * cells_.factor);
  return static_cast<float>(std::max(options_.min_area_m2 / pixel_m2, min_pixels) * cells_per_pixel);
}

}  // namespace roadstereo
