#pragma once

#include <vector>

#include "evaluate/scan_surface.hpp"

namespace roadstereo::cli {

/// Laser scan, prepared for registration: all points, and a voxel-downsampled copy with normals and edges.
struct ScanModel {
  /// Throws Error for fewer than 16 points, before or after downsampling.
  explicit ScanModel(const Points& points);

  /// Whether the nearest point of the scan is not at its edge. There is no reference beyond the rim of the cast and
  /// over holes of the scan.
  bool covers(const Eigen::Vector3d& point) const;

  PrincipalAxes axes;
  ScanSurface scan;
  ScanSurface voxels;                        ///< voxel-downsampled
  std::vector<ScanSurface::Surfel> surfels;  ///< of the points of `voxels`
};

}  // namespace roadstereo::cli
