#pragma once

#include <cstddef>
#include <vector>

#include "evaluate/rigid_registration.hpp"

namespace roadstereo::cli {

/// Distances of the points of a pothole to the nearest points of its laser scan. All measured pixels count.
struct ScanScore {
  std::size_t labelled = 0;  ///< pixels of the pothole
  std::size_t measured = 0;  ///< labelled pixels with a point
  double rms_mm = 0;         ///< the published measure
  double median_mm = 0;
  double p90_mm = 0;             ///< 90th percentile
  double p99_mm = 0;             ///< 99th percentile
  std::size_t covered = 0;       ///< measured pixels whose point is not beyond the rim of the scan or over its holes
  double rms_covered_mm = 0;     ///< RMS over the covered pixels
  double rms_or_missing_mm = 0;  ///< RMS with 10 mm for every labelled pixel without a point

  /// Share of the labelled pixels with a point, 0 … 1.
  double completeness() const { return static_cast<double>(measured) / static_cast<double>(labelled); }
};

/// Distance of a point to the nearest point of the scan.
struct ScanDistance {
  double mm = 0;
  bool covered = true;  ///< `ScanModel::covers`
};

/// Distances of all points of the cloud after the motion.
std::vector<ScanDistance> closest_distances(const Points& cloud, const ScanModel& scan, const RigidMotion& motion);

/// Score the distances. `labelled` is the number of labelled pixels. Throws Error when it is less than the number of
/// distances, or there is no distance.
ScanScore score_distances(const std::vector<ScanDistance>& distances, std::size_t labelled);

}  // namespace roadstereo::cli
