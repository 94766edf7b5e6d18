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

constexpr std::size_t neighbours = 16;

/// What nanoflann asks of a set of points.
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

/// The widest angle about a point, radians, in which it has no neighbour. `axes`: the plane that they lie in.
double widest_gap(const Eigen::Vector3d& point, const Points& around, const Eigen::Matrix3d& axes) {
  std::vector<double> angles;
  for (const Eigen::Vector3d& neighbour : around) {
    const Eigen::Vector3d local = axes.transpose() * (neighbour - point);
    if (local.squaredNorm() > 0) angles.push_back(std::atan2(local[1], local[0]));
  }
  if (angles.empty()) return 2 * std::numbers::pi;
  std::sort(angles.begin(), angles.end());
  double widest = angles.front() + 2 * std::numbers::pi - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) widest = std::max(widest, angles[i] - angles[i - 1]);
  return widest;
}

}  // namespace

struct ScanSurface::Tree {
  explicit Tree(Points given) : set{std::move(given)}, index(3, set) { index.buildIndex(); }

  TreePoints set;
  KdTree index;
};

MainAxes main_axes(const Points& points) {
  MainAxes result;
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
  result.spread = solver.eigenvalues().reverse().cwiseMax(0).cwiseSqrt();
  return result;
}

Points thin_out(const Points& points, double side) {
  struct Cube {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
  };
  std::map<std::array<long, 3>, Cube> cubes;
  for (const Eigen::Vector3d& point : points) {
    std::array<long, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      at[axis] = std::lround(point[static_cast<Eigen::Index>(axis)] / side);
    }
    Cube& cube = cubes[at];
    cube.sum += point;
    ++cube.count;
  }
  Points thinned;
  thinned.reserve(cubes.size());
  for (const auto& [at, cube] : cubes) thinned.emplace_back(cube.sum / cube.count);
  return thinned;
}

Points every_nth(const Points& points, std::size_t most) {
  if (points.size() <= most) return points;
  Points taken;
  taken.reserve(most);
  for (std::size_t i = 0; i < most; ++i) taken.push_back(points[i * points.size() / most]);
  return taken;
}

ScanSurface::ScanSurface(Points points) {
  if (points.size() < neighbours) fail("a surface needs at least ", neighbours, " points; it has ", points.size());
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

std::vector<ScanSurface::Lie> ScanSurface::lies() const {
  std::vector<Lie> lies;
  lies.reserve(points().size());
  std::array<std::size_t, neighbours> indices{};
  std::array<double, neighbours> squared{};
  Points around(neighbours);
  for (const Eigen::Vector3d& point : points()) {
    tree_->index.knnSearch(point.data(), neighbours, indices.data(), squared.data());
    for (std::size_t i = 0; i < neighbours; ++i) around[i] = points()[indices[i]];
    const Eigen::Matrix3d axes = main_axes(around).axes;
    lies.push_back({axes.col(2), widest_gap(point, around, axes) > 2 * std::numbers::pi / 3});
  }
  return lies;
}

const Points& ScanSurface::points() const {
  return tree_->set.points;
}

}  // namespace roadstereo::cli
