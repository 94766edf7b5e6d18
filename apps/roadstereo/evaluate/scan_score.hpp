#pragma once

#include <cstddef>
#include <vector>

#include "evaluate/rigid_registration.hpp"

namespace roadstereo::cli {

/// How far the points of a pothole lie from its laser scan, millimetres. Every measured pixel counts, none is trimmed.
struct ScanScore {
  std::size_t labelled = 0;   ///< pixels of the pothole
  std::size_t measured = 0;   ///< of those, with a point
  double rms_mm = 0;          ///< of the distances to the nearest point of the scan: the published measure
  double median_mm = 0;       ///< of the same
  double p90_mm = 0;          ///< 90 % of the points lie no farther away
  double p99_mm = 0;          ///< likewise
  std::size_t covered = 0;    ///< measured pixels whose point lies over the scan, not beyond its rim or over its holes
  double rms_covered_mm = 0;  ///< RMS of those
  double rms_or_missing_mm = 0;  ///< RMS with 10 mm for every labelled pixel without a point

  /// Share of the labelled pixels that have a point, 0 … 1.
  double completeness() const { return static_cast<double>(measured) / static_cast<double>(labelled); }
};

/// A point's distance to the nearest one of the scan.
struct ScanDistance {
  double mm = 0;
  bool covered = true;  ///< ScanModel::covers
};

/// Of every point, after the motion.
std::vector<ScanDistance> closest_distances(const Points& cloud, const ScanModel& scan, const RigidMotion& motion);

/// `labelled` pixels were asked for. Throws Error when it is less than the number of distances, or there is none.
ScanScore score_distances(const std::vector<ScanDistance>& distances, std::size_t labelled);

}  // namespace roadstereo::cli
