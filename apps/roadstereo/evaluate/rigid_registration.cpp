#include "evaluate/rigid_registration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr int turns = 36;  // starts about the shortest axis; each of them also upside down
constexpr std::size_t refined_starts = 6;
constexpr std::size_t ranking_points = 500;
constexpr std::size_t choosing_points = 2000;
constexpr std::size_t final_points = 10000;
constexpr int ranking_steps = 20;
constexpr int refining_steps = 80;
constexpr int polishing_steps = 100;
constexpr double settled = 1e-5;  // change of a step, of the surface's extent

struct Pose {
  RigidMotion motion;
  double rms = 0;
};

struct Pairs {
  std::vector<ScanSurface::Nearest> nearest;
  std::vector<double> sorted;  ///< distances
};

Pairs find_pairs(const Points& cloud, const ScanSurface& surface, const RigidMotion& motion) {
  Pairs pairs;
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

double trimmed_rms(const Pairs& pairs, double share) {
  const std::size_t kept = kept_count(share, pairs.sorted.size());
  double squares = 0;
  for (std::size_t i = 0; i < kept; ++i) squares += pairs.sorted[i] * pairs.sorted[i];
  return std::sqrt(squares / static_cast<double>(kept));
}

/// The motion that brings the points closest to their partners, over the nearest share of them, in closed form.
RigidMotion fit_points(const Points& cloud, const ScanSurface& surface, const Pairs& pairs, double share) {
  const double limit = pairs.sorted[kept_count(share, pairs.sorted.size()) - 1];
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (pairs.nearest[i].distance > limit) continue;
    const Eigen::Vector3d& partner = surface.points()[pairs.nearest[i].index];
    from += cloud[i];
    to += partner;
    products += cloud[i] * partner.transpose();
    count += 1;
  }
  const Eigen::Matrix3d covariance = products - from * to.transpose() / count;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const bool mirrored = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0;
  const Eigen::Vector3d signs(1, 1, mirrored ? -1 : 1);
  RigidMotion motion;
  motion.rotation = svd.matrixV() * signs.asDiagonal() * svd.matrixU().transpose();
  motion.translation = (to - motion.rotation * from) / count;
  return motion;
}

/// How far a step moves the points of a cloud, at the most.
double step_length(const RigidMotion& before, const RigidMotion& after, const Eigen::Vector3d& centre, double extent) {
  return (after(centre) - before(centre)).norm() + (after.rotation - before.rotation).norm() * extent;
}

Pose fit_by_points(const Points& cloud, const ScanSurface& surface, Pose pose, double share, int steps) {
  const MainAxes axes = main_axes(cloud);
  const double extent = axes.spread[0];
  for (int step = 0; step < steps; ++step) {
    const RigidMotion next = fit_points(cloud, surface, find_pairs(cloud, surface, pose.motion), share);
    const double length = step_length(pose.motion, next, axes.centre, extent);
    pose.motion = next;
    if (length < settled * extent) break;
  }
  pose.rms = trimmed_rms(find_pairs(cloud, surface, pose.motion), share);
  return pose;
}

/// Tukey's weight of a distance.
double tukey_weight(double distance, double scale) {
  constexpr double reach = 4.685;
  const double share = distance / (reach * scale);
  return share < 1 ? (1 - share * share) * (1 - share * share) : 0;
}

/// One step of Gauss and Newton on the distances to the planes of the nearest points, about the cloud's place.
RigidMotion step_to_planes(const Points& cloud, const ScanModel& scan, const RigidMotion& motion, double least_scale) {
  const Pairs pairs = find_pairs(cloud, scan.even, motion);
  constexpr double to_sigma = 1.4826;
  const double scale = std::max(to_sigma * pairs.sorted[pairs.sorted.size() / 2], least_scale);
  const Eigen::Vector3d pivot = motion(main_axes(cloud).centre);
  Matrix6 normal_matrix = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double weight = tukey_weight(pairs.nearest[i].distance, scale);
    const ScanSurface::Lie& lie = scan.lies[pairs.nearest[i].index];
    if (weight <= 0 || lie.at_edge) continue;  // a plane does not end where the scan does
    const Eigen::Vector3d point = motion(cloud[i]);
    const Eigen::Vector3d& normal = lie.normal;
    Vector6 row;
    row << (point - pivot).cross(normal), normal;
    normal_matrix += weight * row * row.transpose();
    right -= weight * row * normal.dot(point - scan.even.points()[pairs.nearest[i].index]);
  }
  constexpr double damping = 1e-6;  // a sphere may turn as it likes
  normal_matrix.diagonal() *= 1 + damping;
  const Vector6 solution = normal_matrix.ldlt().solve(right);
  const Eigen::Vector3d turn = solution.head<3>();
  const double angle = turn.norm();
  const Eigen::Matrix3d rotation =
      angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
  RigidMotion next;
  next.rotation = rotation * motion.rotation;
  next.translation = rotation * (motion.translation - pivot) + pivot + solution.tail<3>();
  return next;
}

Pose fit_to_planes(const Points& cloud, const ScanModel& scan, Pose pose, double share) {
  const MainAxes axes = main_axes(cloud);
  constexpr double least_scale_share = 1e-3;
  const double extent = axes.spread[0];
  for (int step = 0; step < refining_steps; ++step) {
    const RigidMotion next = step_to_planes(cloud, scan, pose.motion, least_scale_share * extent);
    if (!next.translation.allFinite() || !next.rotation.allFinite()) break;
    const double length = step_length(pose.motion, next, axes.centre, extent);
    pose.motion = next;
    if (length < settled * extent) break;
  }
  pose.rms = trimmed_rms(find_pairs(cloud, scan.even, pose.motion), share);
  return pose;
}

/// Both on their main axes: all turns about the shortest one, and all of them upside down.
std::vector<RigidMotion> starts(const Points& cloud, const MainAxes& to) {
  const MainAxes from = main_axes(cloud);
  std::vector<RigidMotion> motions;
  for (int i = 0; i < 2 * turns; ++i) {
    const int turn = i / 2;
    const double angle = 2 * std::numbers::pi * turn / turns;
    Eigen::Matrix3d local = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    if (i % 2 == 1) local *= Eigen::Vector3d(1, -1, -1).asDiagonal();
    RigidMotion motion;
    motion.rotation = to.axes * local * from.axes.transpose();
    motion.translation = to.centre - motion.rotation * from.centre;
    motions.push_back(motion);
  }
  return motions;
}

bool is_elsewhere(const RigidMotion& one, const RigidMotion& other, const MainAxes& cloud) {
  constexpr double most_turn_rad = 10 * std::numbers::pi / 180;
  constexpr double most_shift = 0.3;  // standard deviations: about a tenth of the extent
  const double turn = Eigen::AngleAxisd(one.rotation.transpose() * other.rotation).angle();
  return turn > most_turn_rad || (one(cloud.centre) - other(cloud.centre)).norm() > most_shift * cloud.spread[0];
}

/// The starts after a few steps on few points, best first.
std::vector<Pose> ranked_starts(const Points& cloud, const ScanModel& scan, const RegistrationOptions& options) {
  constexpr double coarse_side = 0.12;  // of the standard deviation along the longest axis
  const ScanSurface coarse(thin_out(scan.scan.points(), coarse_side * scan.axes.spread[0]));
  const Points few = every_nth(cloud, ranking_points);
  std::vector<Pose> poses;
  for (const RigidMotion& motion : starts(few, scan.axes)) {
    poses.push_back(fit_by_points(few, coarse, {motion}, options.trimmed_share, ranking_steps));
  }
  std::stable_sort(poses.begin(), poses.end(), [](const Pose& a, const Pose& b) { return a.rms < b.rms; });
  return poses;
}

/// Of the ranked ones, the first that differ from each other.
std::vector<Pose> different_poses(const std::vector<Pose>& ranked, const MainAxes& cloud, std::size_t most) {
  std::vector<Pose> chosen;
  for (const Pose& pose : ranked) {
    const bool is_new = std::all_of(chosen.begin(), chosen.end(),
                                    [&](const Pose& other) { return is_elsewhere(pose.motion, other.motion, cloud); });
    if (is_new && chosen.size() < most) chosen.push_back(pose);
  }
  return chosen;
}

/// Follows a pose to its end. The last step, when there is one, is taken towards the points of `surface`.
Pose refine(const Points& cloud, const ScanModel& scan, const ScanSurface& surface, const Pose& start,
            const RegistrationOptions& options) {
  Pose robust = fit_to_planes(cloud, scan, start, options.trimmed_share);
  if (options.last_step == LastStep::robust) return robust;
  return fit_by_points(cloud, surface, robust, 1, polishing_steps);
}

}  // namespace

void RegistrationOptions::validate() const {
  constexpr double least_share = 0.3;
  if (trimmed_share >= least_share && trimmed_share <= 1) return;
  fail("trimmed_share is ", trimmed_share, "; it must be between ", least_share, " and 1");
}

Registration register_cloud(const Points& cloud, const ScanModel& scan, const RegistrationOptions& options) {
  options.validate();
  constexpr std::size_t least_points = 100;
  if (cloud.size() < least_points) fail("the cloud has ", cloud.size(), " points; registration needs ", least_points);
  const MainAxes cloud_axes = main_axes(cloud);
  const Points some = every_nth(cloud, choosing_points);
  std::vector<Pose> poses = different_poses(ranked_starts(cloud, scan, options), cloud_axes, refined_starts);
  for (Pose& pose : poses) pose = refine(some, scan, scan.even, pose, options);
  std::stable_sort(poses.begin(), poses.end(), [](const Pose& a, const Pose& b) { return a.rms < b.rms; });
  const Pose best = refine(every_nth(cloud, final_points), scan, scan.scan, poses.front(), options);
  Registration result{best.motion, best.rms, std::numeric_limits<double>::infinity()};
  for (const Pose& pose : poses) {
    const bool elsewhere = is_elsewhere(pose.motion, poses.front().motion, cloud_axes);
    if (elsewhere) result.next_rms = std::min(result.next_rms, pose.rms);
  }
  return result;
}

}  // namespace roadstereo::cli
