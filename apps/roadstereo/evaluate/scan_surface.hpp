#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

namespace roadstereo::cli {

using Points = std::vector<Eigen::Vector3d>;

/// Centre of gravity of some points, and their main axes as columns: longest first, right-handed.
struct MainAxes {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d spread = Eigen::Vector3d::Zero();  ///< standard deviation along each axis
};
MainAxes main_axes(const Points& points);

/// The mean of the points in every cube of that side, in the order of the cubes.
Points thin_out(const Points& points, double side);

/// At most `most` of the points, evenly taken.
Points every_nth(const Points& points, std::size_t most);

/// A surface given by points: who is nearest, and how the surface lies there.
class ScanSurface {
 public:
  /// Throws Error when there are fewer than 16 points.
  explicit ScanSurface(Points points);
  ~ScanSurface();
  ScanSurface(ScanSurface&&) noexcept;
  ScanSurface& operator=(ScanSurface&&) noexcept;

  struct Nearest {
    std::size_t index = 0;
    double distance = 0;
  };
  Nearest nearest(const Eigen::Vector3d& point) const;

  /// How the surface lies around every point, by the 16 nearest ones.
  struct Lie {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit vector, of either sign
    bool at_edge = false;                               ///< nothing follows within a third of the directions
  };
  std::vector<Lie> lies() const;
  const Points& points() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace roadstereo::cli
