#include "odometry/link_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/degrees.hpp"
#include "odometry/patch_matching.hpp"
#include "odometry/phase_correlation.hpp"

namespace roadstereo {
namespace {

/// Adjoint: how a small motion of camera `from` moves camera `to`.
Matrix<6> adjoint(const RigidMotion& motion) {
  Matrix<6> result{};
  const Vector<3>& t = motion.translation;
  for (std::size_t j = 0; j < 3; ++j) {
    const Vector<3> column{motion.rotation[0][j], motion.rotation[1][j], motion.rotation[2][j]};
    const Vector<3> lever = cross(t, column);
    for (std::size_t i = 0; i < 3; ++i) {
      result[i][j] = column[i];
      result[i + 3][j + 3] = column[i];
      result[i][j + 3] = lever[i];
    }
  }
  return result;
}

}  // namespace

std::array<double, 12> matrix_of(const RigidMotion& motion) {
  std::array<double, 12> matrix{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) matrix[4 * i + j] = motion.rotation[i][j];
    matrix[4 * i + 3] = motion.translation[i];
  }
  return matrix;
}

RigidMotion motion_of(const std::array<double, 12>& matrix) {
  RigidMotion motion;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) motion.rotation[i][j] = matrix[4 * i + j];
    motion.translation[i] = matrix[4 * i + 3];
  }
  return motion;
}

std::array<double, 36> carried(const RigidMotion& motion, const std::array<double, 36>& c) {
  const Matrix<6> a = adjoint(motion);
  std::array<double, 36> result{};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      for (std::size_t k = 0; k < 6; ++k) {
        for (std::size_t l = 0; l < 6; ++l) result[6 * i + j] += a[i][k] * c[6 * k + l] * a[j][l];
      }
    }
  }
  return result;
}

FrameLink frame_link(int from, int to, const Alignment& alignment, const OdometryOptions& options) {
  FrameLink link;
  link.from = from;
  link.to = to;
  link.status = alignment.correlation < options.weak_correlation ? LinkStatus::weak : LinkStatus::good;
  link.motion = matrix_of(alignment.motion);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) link.covariance[6 * i + j] = alignment.covariance[i][j];
  }
  link.correlation = alignment.correlation;
  link.overlap = alignment.overlap;
  link.offset_px = alignment.offset_px;
  link.offset_sd_px = alignment.offset_sd_px;
  link.measured_offset_px = alignment.measured_offset_px;
  link.measured_offset_sd_px = alignment.measured_offset_sd_px;
  link.rig_offset_px = alignment.rig_offset_px;
  link.rig_offset_sd_px = alignment.rig_offset_sd_px;
  link.shutter = alignment.shutter;
  link.shutter_sd = alignment.shutter_sd;
  return link;
}

void LinkEstimator::select(const LinkMaps& maps, const OdometryFrame& frame, LinkReference& reference) const {
  select_points(maps, reference.points);
  reference.road.reset();
  FrameRoad road;
  if (frame.has_road && frame_road(frame.road, calibration_, frame.grey.width(), frame.grey.height(), road)) {
    reference.road = road;
    sample_ground(maps.pyramid, calibration_, road, road.grid, 0, reference.ground);
  }
}

bool LinkEstimator::accepted(const Alignment& alignment) const {
  return alignment.correlation >= options_.min_correlation && alignment.overlap >= options_.min_overlap;
}

/// No motion; where the road planes of both frames agree best, whatever the motion; and motions along the road, which
/// a road without texture does not show from above. Their step leaves no gap between searches of patches.
std::vector<RigidMotion> LinkEstimator::starts(const LinkReference& from, const LinkMaps& maps,
                                               const OdometryFrame& frame, double yaw_rad) const {
  constexpr int max_yaw_steps = 4;
  constexpr double yaw_step_rad = to_radians(2);
  constexpr int peaks_per_yaw = 2;
  constexpr std::size_t max_starts = 6;
  constexpr int max_steps = 6;
  constexpr double step_of_height = 0.7;
  std::vector<RigidMotion> result{RigidMotion{}};
  FrameRoad road;
  if (!from.road || !frame.has_road ||
      !frame_road(frame.road, calibration_, frame.grey.width(), frame.grey.height(), road)) {
    return result;
  }
  const GroundGrid& fixed = from.road->grid;
  const GroundGrid grid{fixed.cell_m, road.grid.centre_x_m, road.grid.centre_y_m};
  std::vector<std::pair<double, RigidMotion>> found;
  const Spectrum ground = spectrum(from.ground, GroundGrid::side);
  std::vector<float> cells;
  for (int step = -max_yaw_steps; step <= max_yaw_steps; ++step) {
    const double yaw = yaw_rad + step * yaw_step_rad;
    sample_ground(maps.pyramid, calibration_, road, grid, yaw, cells);
    for (const CorrelationPeak& peak :
         phase_correlation(ground, spectrum(cells, GroundGrid::side), GroundGrid::side, peaks_per_yaw)) {
      const double x = peak.x * grid.cell_m - fixed.centre_x_m, y = peak.y * grid.cell_m - fixed.centre_y_m;
      const double cosine = std::cos(yaw), sine = std::sin(yaw);
      found.emplace_back(peak.height, planar_motion(*from.road, road, yaw, grid.centre_x_m + cosine * x - sine * y,
                                                    grid.centre_y_m + sine * x + cosine * y));
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (std::size_t i = 0; i < std::min(found.size(), max_starts); ++i) result.push_back(found[i].second);
  for (int step = 1; step <= max_steps; ++step) {
    const double length_m = step * step_of_height * road.plane.height_m;
    for (const double y_m : {-length_m, length_m}) result.push_back(planar_motion(*from.road, road, 0, 0, y_m));
  }
  return result;
}

/// Best alignment from a prediction: from where it puts the points, or else from where their patches are found around
/// that.
Alignment LinkEstimator::track(const LinkReference& from, const LinkMaps& maps, const RigidMotion& start,
                               const LinkPrior& prior) const {
  constexpr double as_usual = 0.93;  // of the correlation of the last links
  const double enough = prior.usual_correlation > 0 ? as_usual * prior.usual_correlation : options_.weak_correlation;
  constexpr int search_radius = 6, coarsest = 1, coarsest_search = 3;
  Alignment best = align(from.points, maps, calibration_, start, prior.offset, coarsest, 0, options_.threads);
  if (best.overlap < options_.min_overlap) best.correlation = 0;
  for (int top = 1; top <= std::min(maps.pyramid.levels() - 1, coarsest_search); ++top) {
    if (best.correlation >= enough) break;
    RigidMotion motion = start;
    for (int level = top; level >= 1; --level) {
      motion = match_patches(from.points, maps, calibration_, motion, prior.offset.mean_px, level, search_radius);
    }
    const Alignment other = align(from.points, maps, calibration_, motion, prior.offset, coarsest, 0, options_.threads);
    if (other.correlation > best.correlation && other.overlap >= options_.min_overlap) best = other;
  }
  return best;
}

std::optional<Alignment> LinkEstimator::link(const LinkReference& from, const LinkMaps& maps,
                                             const OdometryFrame& frame, const LinkPrior& prior) const {
  constexpr double as_before = 0.6;
  Alignment best;
  if (prior.motion) best = track(from, maps, *prior.motion, prior);
  const double wanted = std::max(options_.weak_correlation, as_before * prior.usual_correlation);
  if (!accepted(best) || best.correlation < wanted) {
    for (const RigidMotion& candidate : starts(from, maps, frame, prior.yaw_rad)) {
      const Alignment other = track(from, maps, candidate, prior);
      if (other.correlation > best.correlation && other.overlap >= options_.min_overlap) best = other;
      if (best.correlation >= wanted) break;
    }
  }
  return accepted(best) ? std::optional(best) : std::nullopt;
}

}  // namespace roadstereo
