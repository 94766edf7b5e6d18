#include "evaluate/scan_surface.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nanoflann.hpp>
#include <numbers>
#include <utility>

#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

constexpr std::size_t neighbour_count = 16;

/// Adaptor of points for nanoflann.
struct TreePoints {
  Points points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return points[index][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

using KdTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, TreePoints>, TreePoints, 3, std::size_t>;

/// Maximum angle, radians, between the directions of successive neighbours in the tangent plane of the point.
double max_gap(const Eigen::Vector3d& point, const Points& around, const Eigen::Matrix3d& axes) {
  std::vector<double> angles;
  for (const Eigen::Vector3d& neighbour : around) {
    const Eigen::Vector3d local = axes.transpose() * (neighbour - point);
    if (local.squaredNorm() > 0) angles.push_back(std::atan2(local[1], local[0]));
  }
  if (angles.empty()) return 2 * std::numbers::pi;
  std::sort(angles.begin(), angles.end());
  double max = angles.front() + 2 * std::numbers::pi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) max = std::max(max, angles[i] - angles[i - 1]);
  return max;
}

}  // namespace

struct ScanSurface::Tree {
  explicit Tree(Points points) : set{std::move(points)}, index(3, set) { index.buildIndex(); }

  TreePoints set;
  KdTree index;
};

PrincipalAxes principal_axes(const Points& points) {
  PrincipalAxes result;
  for (const Eigen::Vector3d& point : points) result.centre += point;
  result.centre /= static_cast<double>(points.size());
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    moments += (point - result.centre) * (point - result.centre).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments / static_cast<double>(points.size()));
  result.axes.col(0) = solver.eigenvectors().col(2);
  result.axes.col(1) = solver.eigenvectors().col(1);
  result.axes.col(2) = result.axes.col(0).cross(result.axes.col(1));
  result.sigma = solver.eigenvalues().reverse().cwiseMax(0).cwiseSqrt();
  return result;
}

Points voxel_downsample(const Points& points, double side) {
  struct Voxel {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
  };
  std::map<std::array<long, 3>, Voxel> voxels;
  for (const Eigen::Vector3d& point : points) {
    std::array<long, 3> index{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      index[axis] = std::lround(point[static_cast<Eigen::Index>(axis)] / side);
    }
    Voxel& voxel = voxels[index];
    voxel.sum += point;
    ++voxel.count;
  }
  Points means;
  means.reserve(voxels.size());
  for (const auto& [index, voxel] : voxels) means.emplace_back(voxel.sum / voxel.count);
  return means;
}

Points subsample_evenly(const Points& points, std::size_t max_count) {
  if (points.size() <= max_count) return points;
  Points subset;
  subset.reserve(max_count);
  for (std::size_t i = 0; i < max_count; ++i) subset.push_back(points[i * points.size() / max_count]);
  return subset;
}

ScanSurface::ScanSurface(Points points) {
  if (points.size() < neighbour_count) {
    fail("the surface has ", points.size(), " points; it must have at least ", neighbour_count);
  }
  tree_ = std::make_unique<Tree>(std::move(points));
}

ScanSurface::~ScanSurface() = default;
ScanSurface::ScanSurface(ScanSurface&&) noexcept = default;
ScanSurface& ScanSurface::operator=(ScanSurface&&) noexcept = default;

ScanSurface::Nearest ScanSurface::nearest(const Eigen::Vector3d& point) const {
  Nearest found;
  double squared = 0;
  tree_->index.knnSearch(point.data(), 1, &found.index, &squared);
  found.distance = std::sqrt(squared);
  return found;
}

std::vector<ScanSurface::Surfel> ScanSurface::surfels() const {
  constexpr double min_edge_gap = 2 * std::numbers::pi / 3;
  std::vector<Surfel> surfels;
  surfels.reserve(points().size());
  std::array<std::size_t, neighbour_count> indices{};
  std::array<double, neighbour_count> squared{};
  Points around(neighbour_count);
  for (const Eigen::Vector3d& point : points()) {
    tree_->index.knnSearch(point.data(), neighbour_count, indices.data(), squared.data());
    for (std::size_t i = 0; i < neighbour_count; ++i) around[i] = points()[indices[i]];
    const Eigen::Matrix3d axes = principal_axes(around).axes;
    surfels.push_back({axes.col(2), max_gap(point, around, axes) > min_edge_gap});
  }
  return surfels;
}

const Points& ScanSurface::points() const {
  return tree_->set.points;
}

}  // namespace roadstereo::cli
