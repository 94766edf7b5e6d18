#pragma once

#include "damage/cells.hpp"
#include "damage/road_surface.hpp"

namespace roadstereo {

/// What decides which departures from the road are damage, cell by cell: standard errors and shares of the picture, or
/// metres where they are known and more. Depths in pixels of ℓ'.
class Thresholds {
 public:
  /// `noise` is that of a cell of the intact road. The coordinates must live as long as this.
  Thresholds(const DamageInput& input, const DamageOptions& options, const Cells& cells,
             const SurfaceCoordinates& coordinates, double noise, bool metric);

  bool metric() const { return metric_; }
  /// Depth that counts.
  float depth(int i, int j) const { return std::max(noise_, static_cast<float>(min_depth_m_ * scale_(i, j))); }
  /// The same of a whole row.
  void depths(int j, float* row) const;
  /// A depression that is deeper is no damage, and no protrusion that is higher.
  float deepest(int i, int j) const { return in_pixels(options_.max_depth_m, i, j); }
  float highest(int i, int j) const { return in_pixels(options_.max_height_m, i, j); }
  /// Area that counts, cells.
  float least_cells(int i, int j) const;

 private:
  float in_pixels(double metres, int i, int j) const;

  const DamageInput& input_;
  const DamageOptions& options_;
  const Cells& cells_;
  const Image<float>& scale_;
  bool metric_;
  float noise_;
  double min_depth_m_;
  double height_m_ = 0;  ///< of the camera
};

}  // namespace roadstereo
