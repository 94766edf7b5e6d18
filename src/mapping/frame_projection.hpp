#pragma once

#include <array>
#include <optional>

#include "core/colour_reader.hpp"
#include "mapping/map_cell.hpp"
#include "roadstereo/road_map.hpp"

namespace roadstereo {

/// Heights of cells from one frame: fixed-point iteration along the vertical of the cell.
class FrameProjection {
 public:
  FrameProjection(const MapFrame& frame, const RoadMapOptions& options);

  /// Returns the box of the cells that the frame shows sharply enough; empty if there are none.
  MapBox footprint() const;

  /// Measures the surface above (x, y) of the map. Nothing if the frame does not show it.
  std::optional<CellMeasurement> measure(double x, double y) const;

 private:
  std::optional<std::array<double, 2>> pixel_of(double x, double y, double z) const;
  std::optional<double> disparity_at(double u, double v) const;
  bool is_sharp(double u, double v) const;

  const MapFrame& frame_;
  const RoadMapOptions& options_;
  RigidTransform map_to_camera_;
  ColourReader colours_;
  // Plane of the road in the map: z = offset + slope_x·x + slope_y·y.
  double offset_ = 0, slope_x_ = 0, slope_y_ = 0;
  double normal_height_m_ = 0;  ///< of the camera above the plane, along its normal
};

}  // namespace roadstereo
