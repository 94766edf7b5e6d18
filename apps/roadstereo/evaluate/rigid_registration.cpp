#include "evaluate/rigid_registration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/degrees.hpp"
#include "core/order_statistics.hpp"
#include "core/tukey.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr int rotation_count = 36;              // initial rotations about the shortest axis; each also upside down
constexpr std::size_t refined_pose_count = 12;  // of p1_01 the best is not among the first six
constexpr std::size_t ranking_points = 500;
constexpr std::size_t refining_points = 2000;
constexpr std::size_t final_points = 10000;
constexpr int ranking_iterations = 20;
constexpr int refining_iterations = 80;
constexpr int final_iterations = 100;
constexpr double trimmed_share = 0.8;  // nearest share of the points that ranks initial poses
constexpr double convergence = 1e-5;   // step length, relative to the extent of the surface

/// Motion with the RMS of its closest distances.
struct Pose {
  RigidMotion motion;
  double rms = 0;
};

/// Closest points of the surface, one per point of the cloud.
struct Correspondences {
  std::vector<ScanSurface::Nearest> nearest;
  std::vector<double> sorted;  ///< distances in ascending order
};

Correspondences find_correspondences(const Points& cloud, const ScanSurface& surface, const RigidMotion& motion) {
  Correspondences pairs;
  pairs.nearest.reserve(cloud.size());
  pairs.sorted.reserve(cloud.size());
  for (const Eigen::Vector3d& point : cloud) {
    pairs.nearest.push_back(surface.nearest(motion(point)));
    pairs.sorted.push_back(pairs.nearest.back().distance);
  }
  std::sort(pairs.sorted.begin(), pairs.sorted.end());
  return pairs;
}

std::size_t kept_count(double share, std::size_t points) {
  return std::max<std::size_t>(3, static_cast<std::size_t>(share * static_cast<double>(points)));
}

/// RMS of the nearest share of the distances.
double trimmed_rms(const Correspondences& pairs, double share) {
  const std::size_t kept = kept_count(share, pairs.sorted.size());
  double squares = 0;
  for (std::size_t i = 0; i < kept; ++i) squares += pairs.sorted[i] * pairs.sorted[i];
  return std::sqrt(squares / static_cast<double>(kept));
}

/// Least-squares motion from the nearest share of the points to their correspondences, in closed form by SVD (Kabsch).
RigidMotion fit_motion(const Points& cloud, const ScanSurface& surface, const Correspondences& pairs, double share) {
  const double limit = pairs.sorted[kept_count(share, pairs.sorted.size()) - 1];
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (pairs.nearest[i].distance > limit) continue;
    const Eigen::Vector3d& target = surface.points()[pairs.nearest[i].index];
    from += cloud[i];
    to += target;
    products += cloud[i] * target.transpose();
    count += 1;
  }
  const Eigen::Matrix3d covariance = products - from * to.transpose() / count;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const bool is_mirrored = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0;
  const Eigen::Vector3d signs(1, 1, is_mirrored ? -1 : 1);
  RigidMotion motion;
  motion.rotation = svd.matrixV() * signs.asDiagonal() * svd.matrixU().transpose();
  motion.translation = (to - motion.rotation * from) / count;
  return motion;
}

/// Upper bound on the distance by which a step moves the points of a cloud.
double step_length(const RigidMotion& before, const RigidMotion& after, const Eigen::Vector3d& centre, double extent) {
  return (after(centre) - before(centre)).norm() + (after.rotation - before.rotation).norm() * extent;
}

/// Trimmed point-to-point ICP.
Pose icp_point_to_point(const Points& cloud, const ScanSurface& surface, Pose pose, double share, int iterations) {
  const PrincipalAxes axes = principal_axes(cloud);
  const double extent = axes.sigma[0];
  for (int i = 0; i < iterations; ++i) {
    const RigidMotion next = fit_motion(cloud, surface, find_correspondences(cloud, surface, pose.motion), share);
    const double length = step_length(pose.motion, next, axes.centre, extent);
    pose.motion = next;
    if (length < convergence * extent) break;
  }
  pose.rms = trimmed_rms(find_correspondences(cloud, surface, pose.motion), share);
  return pose;
}

/// One Gauss–Newton step of robust point-to-plane ICP, with rotations about the centre of the cloud.
RigidMotion point_to_plane_step(const Points& cloud, const ScanModel& scan, const RigidMotion& motion,
                                double min_scale) {
  const Correspondences pairs = find_correspondences(cloud, scan.voxels, motion);
  const double scale = std::max(gaussian_mad * pairs.sorted[pairs.sorted.size() / 2], min_scale);
  const Eigen::Vector3d pivot = motion(principal_axes(cloud).centre);
  Matrix6 normal_matrix = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double weight = tukey_weight(pairs.nearest[i].distance / (tukey * scale));
    const ScanSurface::Surfel& surfel = scan.surfels[pairs.nearest[i].index];
    if (weight <= 0 || surfel.at_edge) continue;  // the tangent plane continues beyond the edge of the scan
    const Eigen::Vector3d point = motion(cloud[i]);
    const Eigen::Vector3d& normal = surfel.normal;
    Vector6 row;
    row << (point - pivot).cross(normal), normal;
    normal_matrix += weight * row * row.transpose();
    right -= weight * row * normal.dot(point - scan.voxels.points()[pairs.nearest[i].index]);
  }
  constexpr double damping = 1e-6;  // for surfaces that do not constrain all rotations, such as a sphere
  normal_matrix.diagonal() *= 1 + damping;
  const Vector6 solution = normal_matrix.ldlt().solve(right);
  const Eigen::Vector3d rotation_vector = solution.head<3>();
  const double angle = rotation_vector.norm();
  const Eigen::Matrix3d rotation =
      angle > 0 ? Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
  RigidMotion next;
  next.rotation = rotation * motion.rotation;
  next.translation = rotation * (motion.translation - pivot) + pivot + solution.tail<3>();
  return next;
}

/// Robust point-to-plane ICP.
Pose icp_point_to_plane(const Points& cloud, const ScanModel& scan, Pose pose) {
  const PrincipalAxes axes = principal_axes(cloud);
  constexpr double min_scale_share = 1e-3;
  const double extent = axes.sigma[0];
  for (int i = 0; i < refining_iterations; ++i) {
    const RigidMotion next = point_to_plane_step(cloud, scan, pose.motion, min_scale_share * extent);
    if (!next.translation.allFinite() || !next.rotation.allFinite()) break;
    const double length = step_length(pose.motion, next, axes.centre, extent);
    pose.motion = next;
    if (length < convergence * extent) break;
  }
  pose.rms = trimmed_rms(find_correspondences(cloud, scan.voxels, pose.motion), trimmed_share);
  return pose;
}

/// Initial motions: principal axes aligned, with all rotations about the shortest axis, each also upside down.
std::vector<RigidMotion> initial_motions(const Points& cloud, const PrincipalAxes& to) {
  const PrincipalAxes from = principal_axes(cloud);
  std::vector<RigidMotion> motions;
  for (int i = 0; i < 2 * rotation_count; ++i) {
    const int rotation = i / 2;
    const double angle = 2 * std::numbers::pi * rotation / rotation_count;
    Eigen::Matrix3d local = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    if (i % 2 == 1) local *= Eigen::Vector3d(1, -1, -1).asDiagonal();
    RigidMotion motion;
    motion.rotation = to.axes * local * from.axes.transpose();
    motion.translation = to.centre - motion.rotation * from.centre;
    motions.push_back(motion);
  }
  return motions;
}

/// Whether two motions differ by more than 10° or a tenth of the extent of the cloud.
bool is_distinct(const RigidMotion& one, const RigidMotion& other, const PrincipalAxes& cloud) {
  constexpr double max_angle_rad = to_radians(10);
  constexpr double max_translation = 0.3;  // standard deviations: about a tenth of the extent
  const double angle = Eigen::AngleAxisd(one.rotation.transpose() * other.rotation).angle();
  return angle > max_angle_rad || (one(cloud.centre) - other(cloud.centre)).norm() > max_translation * cloud.sigma[0];
}

/// Initial poses after a coarse ICP, by ascending RMS.
std::vector<Pose> ranked_poses(const Points& cloud, const ScanModel& scan) {
  constexpr double coarse_voxel = 0.12;  // side, in standard deviations along the longest axis
  const ScanSurface coarse(voxel_downsample(scan.scan.points(), coarse_voxel * scan.axes.sigma[0]));
  const Points few = subsample_evenly(cloud, ranking_points);
  std::vector<Pose> poses;
  for (const RigidMotion& motion : initial_motions(few, scan.axes)) {
    poses.push_back(icp_point_to_point(few, coarse, {motion}, trimmed_share, ranking_iterations));
  }
  std::stable_sort(poses.begin(), poses.end(), [](const Pose& a, const Pose& b) { return a.rms < b.rms; });
  return poses;
}

/// The first `max_count` of the ranked poses that are distinct.
std::vector<Pose> distinct_poses(const std::vector<Pose>& ranked, const PrincipalAxes& cloud, std::size_t max_count) {
  std::vector<Pose> selected;
  for (const Pose& pose : ranked) {
    const bool is_new = std::all_of(selected.begin(), selected.end(),
                                    [&](const Pose& other) { return is_distinct(pose.motion, other.motion, cloud); });
    if (is_new && selected.size() < max_count) selected.push_back(pose);
  }
  return selected;
}

/// Refine a pose by robust ICP and, with LastStep::least_squares, by point-to-point ICP against `surface`.
Pose refine(const Points& cloud, const ScanModel& scan, const ScanSurface& surface, const Pose& start, LastStep last) {
  Pose robust = icp_point_to_plane(cloud, scan, start);
  if (last == LastStep::robust) return robust;
  return icp_point_to_point(cloud, surface, robust, 1, final_iterations);
}

}  // namespace

Registration register_cloud(const Points& cloud, const ScanModel& scan, LastStep last) {
  constexpr std::size_t min_points = 100;
  if (cloud.size() < min_points) fail("the cloud has ", cloud.size(), " points; it must have at least ", min_points);
  const PrincipalAxes cloud_axes = principal_axes(cloud);
  const Points some = subsample_evenly(cloud, refining_points);
  std::vector<Pose> poses = distinct_poses(ranked_poses(cloud, scan), cloud_axes, refined_pose_count);
  for (Pose& pose : poses) pose = refine(some, scan, scan.voxels, pose, last);
  std::stable_sort(poses.begin(), poses.end(), [](const Pose& a, const Pose& b) { return a.rms < b.rms; });
  const Points many = subsample_evenly(cloud, final_points);
  const Pose best = refine(many, scan, scan.scan, poses.front(), last);
  Registration result{best.motion, best.rms, std::numeric_limits<double>::infinity()};
  for (const Pose& pose : poses) {
    if (!is_distinct(pose.motion, best.motion, cloud_axes)) continue;
    const Pose next = refine(many, scan, scan.scan, pose, last);
    if (!is_distinct(next.motion, best.motion, cloud_axes)) continue;
    result.next_rms = next.rms;
    break;
  }
  return result;
}

}  // namespace roadstereo::cli
