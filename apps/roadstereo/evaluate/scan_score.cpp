#include "evaluate/scan_score.hpp"

#include <cmath>

#include "finite_values.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {

std::vector<double> closest_distances(const Points& cloud, const ScanSurface& scan, const RigidMotion& motion) {
  std::vector<double> distances;
  distances.reserve(cloud.size());
  for (const Eigen::Vector3d& point : cloud) distances.push_back(scan.nearest(motion(point)).distance);
  return distances;
}

ScanScore score_distances(const std::vector<double>& distances_mm, std::size_t labelled) {
  if (distances_mm.empty()) fail("no labelled pixel has a disparity");
  if (labelled < distances_mm.size()) {
    fail("the number of labelled pixels is ", labelled, "; the cloud has ", distances_mm.size(), " points");
  }
  constexpr double missing_mm = 10;
  ScanScore score;
  score.labelled = labelled;
  score.measured = distances_mm.size();
  double squares = 0;
  for (const double distance : distances_mm) squares += distance * distance;
  const auto measured = static_cast<double>(score.measured);
  const auto missing = static_cast<double>(labelled - score.measured);
  score.rms_mm = std::sqrt(squares / measured);
  score.rms_or_missing_mm = std::sqrt((squares + missing * missing_mm * missing_mm) / static_cast<double>(labelled));
  score.median_mm = median(distances_mm);
  score.p90_mm = quantile(distances_mm, 0.9);
  score.p99_mm = quantile(distances_mm, 0.99);
  return score;
}

}  // namespace roadstereo::cli
