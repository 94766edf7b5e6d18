#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

namespace roadstereo::cli {

using Points = std::vector<Eigen::Vector3d>;

/// Centroid and principal axes of a point cloud. Axes are columns, longest first, right-handed.
struct PrincipalAxes {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();  ///< standard deviation along each axis
};
PrincipalAxes principal_axes(const Points& points);

/// Voxel-grid downsampling: mean of the points in every cube of that side, in the order of the cubes.
Points voxel_downsample(const Points& points, double side);

/// Evenly spaced subset of at most `max_count` points.
Points subsample_evenly(const Points& points, std::size_t max_count);

/// Surface given by points, with a k-d tree for nearest-neighbour search.
class ScanSurface {
 public:
  /// Throws Error for fewer than 16 points.
  explicit ScanSurface(Points points);
  ~ScanSurface();
  ScanSurface(ScanSurface&&) noexcept;
  ScanSurface& operator=(ScanSurface&&) noexcept;

  struct Nearest {
    std::size_t index = 0;
    double distance = 0;
  };
  /// Nearest point of the surface.
  Nearest nearest(const Eigen::Vector3d& point) const;

  /// Surface element at a point.
  struct Surfel {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit vector of arbitrary sign
    bool at_edge = false;                               ///< whether a third of the directions has no neighbour
  };
  /// Surfels of all points from their 16 nearest neighbours (principal component analysis).
  std::vector<Surfel> surfels() const;
  const Points& points() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace roadstereo::cli
