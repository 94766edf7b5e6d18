#pragma once

#include "damage/cells.hpp"
#include "damage/frame_geometry.hpp"
#include "damage/road_surface.hpp"

namespace roadstereo {

/// Thresholds of the segmentation, per cell. Depths are in pixels of ℓ'. Metric limits apply if the frame is
/// calibrated.
class Thresholds {
 public:
  /// `noise`: standard deviation of a cell of the intact road. All references must outlive this.
  Thresholds(const DamageInput& input, const DamageOptions& options, const Cells& cells,
             const SurfaceCoordinates& coordinates, double noise, bool metric);

  bool metric() const { return metric_; }
  /// Whether the slopes of walls will be measured.
  bool walls_measured() const { return FrameGeometry::is_possible(input_); }
  /// Minimum depth of a core: the larger of threshold_sigma standard deviations and min_depth_m.
  float min_depth(int i, int j) const { return std::max(noise_, static_cast<float>(min_depth_m_ * scale_(i, j))); }
  /// Relief of a rough road, however low the noise: what is no damage by min_depth_m, at most 5 mm; 0 if not metric.
  double relief_m() const {
    constexpr double max_relief_m = 0.005;
    return std::min(min_depth_m_, max_relief_m);
  }
  float relief(int i, int j) const { return static_cast<float>(relief_m() * scale_(i, j)); }
  /// Minimum depths of row j.
  void min_depths(int j, float* row) const;
  /// Maximum depth of a depression; infinity if it is not metric.
  float max_depth(int i, int j) const { return pixels_below(options_.max_depth_m, i, j); }
  /// Maximum height of a protrusion; infinity if it is not metric.
  float max_height(int i, int j) const { return -pixels_below(-options_.max_height_m, i, j); }
  /// Change of the disparity at `depth_m` below the road, negative above it; infinite if it is not metric.
  float pixels_below(double depth_m, int i, int j) const;
  /// Minimum area, cells.
  float min_cells(int i, int j) const;

 private:
  const DamageInput& input_;
  const DamageOptions& options_;
  const Cells& cells_;
  const Image<float>& scale_;  ///< pixels of ℓ' per metre of height
  bool metric_;
  float noise_;  ///< threshold_sigma standard deviations
  double min_depth_m_;
  double camera_height_m_ = 0;
};

}  // namespace roadstereo
