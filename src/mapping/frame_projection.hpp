#pragma once

#include <array>
#include <optional>

#include "mapping/map_cell.hpp"
#include "roadstereo/road_map.hpp"

namespace roadstereo {

/// Colours of pixels of an image of any order and depth, 8 bit.
class ColourReader {
 public:
  ColourReader(const FrameView& image, double white_level);
  std::array<float, 3> at(double u, double v) const;

 private:
  std::array<float, 3> pixel(int u, int v) const;

  FrameView image_;
  float scale_ = 1;
};

/// Heights of cells from one frame: fixed-point iteration along the vertical of the cell.
class FrameProjection {
 public:
  FrameProjection(const MapFrame& frame, const RoadMapOptions& options);

  /// Returns the box of the cells that the frame shows sharply enough; empty if there are none.
  MapBox footprint() const;

  /// Measures the surface above (x, y) of the map. Nothing if the frame does not show it.
  std::optional<CellMeasurement> measure(double x, double y) const;

 private:
  struct Hit {
    double u = 0, v = 0;
    std::array<double, 3> point{};  ///< of the map
    double disparity = 0;           ///< with the offset of the calibration, pixels
    double depth = 0;               ///< along the optical axis, metres
  };
  std::optional<std::array<double, 2>> pixel_of(double x, double y, double z) const;
  std::optional<double> disparity_at(double u, double v) const;
  bool is_sharp(double u, double v) const;
  double height_above_road(const Hit& hit) const;

  const MapFrame& frame_;
  const RoadMapOptions& options_;
  RigidTransform map_to_camera_;
  ColourReader colours_;
  // Plane of the road in the map: z = offset + slope_x·x + slope_y·y.
  double offset_ = 0, slope_x_ = 0, slope_y_ = 0;
  double normal_height_m_ = 0;  ///< of the camera above the plane, along its normal
};

}  // namespace roadstereo
