#pragma once

#include <vector>

#include "evaluate/scan_surface.hpp"

namespace roadstereo::cli {

/// A laser scan made ready: as it is, and thinned to even spacing with normals and edges.
struct ScanModel {
  /// Throws Error when there are fewer than 16 points, or too few of them far enough apart.
  explicit ScanModel(const Points& points);

  /// Whether the scan goes on around its point nearest to this one. Beyond the rim of the cast, and over holes in the
  /// scan, there is nothing to measure against.
  bool covers(const Eigen::Vector3d& point) const;

  MainAxes axes;
  ScanSurface scan;
  ScanSurface even;                    ///< the means of cubes
  std::vector<ScanSurface::Lie> lies;  ///< of the points of `even`
};

}  // namespace roadstereo::cli
