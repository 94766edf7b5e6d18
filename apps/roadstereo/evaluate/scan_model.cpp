#include "evaluate/scan_model.hpp"

namespace roadstereo::cli {
namespace {

constexpr double voxel =
    0.04;  // side, in standard deviations along the longest axis: about 0.8 mm for a pothole of 8 cm

}  // namespace

ScanModel::ScanModel(const Points& points)
    : axes(principal_axes(points)),
      scan(points),
      voxels(voxel_downsample(points, voxel * axes.sigma[0])),
      surfels(voxels.surfels()) {}

bool ScanModel::covers(const Eigen::Vector3d& point) const {
  return !surfels[voxels.nearest(point).index].at_edge;
}

}  // namespace roadstereo::cli
