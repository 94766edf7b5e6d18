#include "evaluate/scan_score.hpp"

#include <cmath>

#include "finite_values.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {

std::vector<ScanDistance> closest_distances(const Points& cloud, const ScanModel& scan, const RigidMotion& motion) {
  std::vector<ScanDistance> distances;
  distances.reserve(cloud.size());
  for (const Eigen::Vector3d& point : cloud) {
    const Eigen::Vector3d moved = motion(point);
    distances.push_back({scan.scan.nearest(moved).distance, scan.covers(moved)});
  }
  return distances;
}

ScanScore score_distances(const std::vector<ScanDistance>& distances, std::size_t labelled) {
  if (distances.empty()) fail("no labelled pixel has a disparity; at least one must have one");
  if (labelled < distances.size()) {
    fail("the number of labelled pixels is ", labelled, "; it must be at least ", distances.size(),
         ", the number of points");
  }
  std::vector<double> all, covered;
  for (const ScanDistance& distance : distances) {
    all.push_back(distance.mm);
    if (distance.covered) covered.push_back(distance.mm);
  }
  constexpr double missing_mm = 10;  // distance of a labelled pixel without a point
  ScanScore score;
  score.labelled = labelled;
  score.measured = all.size();
  score.covered = covered.size();
  const auto measured = static_cast<double>(all.size());
  const auto missing = static_cast<double>(labelled - all.size());
  score.rms_mm = rms(all);
  score.rms_covered_mm = rms(covered);
  const double squares = score.rms_mm * score.rms_mm * measured + missing * missing_mm * missing_mm;
  score.rms_or_missing_mm = std::sqrt(squares / static_cast<double>(labelled));
  score.median_mm = median(all);
  score.p90_mm = quantile(all, 0.9);
  score.p99_mm = quantile(all, 0.99);
  return score;
}

}  // namespace roadstereo::cli
