#include "roadstereo/odometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "odometry/direct_alignment.hpp"
#include "odometry/ground_patch.hpp"
#include "odometry/image_pyramid.hpp"
#include "odometry/patch_matching.hpp"
#include "odometry/phase_correlation.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo {
namespace {

/// Frame that later ones are aligned with.
struct Reference {
  int frame = 0;
  ReferencePoints points;
  std::optional<FrameRoad> road;
  Spectrum ground;  ///< of the road's grid
  FramePose pose;
};

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

/// A C Aᵀ.
std::array<double, 36> carried(const Matrix<6>& a, const std::array<double, 36>& c) {
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

}  // namespace

void OdometryOptions::validate() const {
  const auto require_share = [](const char* name, double value) {
    if (!(value >= 0 && value <= 1)) fail(name, " is ", value, "; it must be between 0 and 1");
  };
  require_share("min_correlation", min_correlation);
  require_share("weak_correlation", weak_correlation);
  require_share("min_overlap", min_overlap);
  require_share("reference_overlap", reference_overlap);
}

const char* name_of(LinkStatus status) {
  return status == LinkStatus::good ? "good" : "weak";
}

struct Odometry::State {
  State(const StereoCalibration& rig, const OdometryOptions& wanted) : calibration(rig), options(wanted) {}

  const FramePose& add(int frame, const OdometryFrame& maps);

  StereoCalibration calibration;
  OdometryOptions options;
  Trajectory trajectory;
  std::vector<FrameLink> links;

 private:
  void require_valid(int frame, const OdometryFrame& maps) const;
  RigidMotion predicted(int frame) const;
  std::optional<Alignment> link(const Reference& from, const FrameMaps& maps, const OdometryFrame& frame,
                                const std::optional<RigidMotion>& start) const;
  std::vector<RigidMotion> starts(const Reference& from, const FrameMaps& maps, const OdometryFrame& frame) const;
  Alignment track(const Reference& from, const FrameMaps& maps, const RigidMotion& start) const;
  OffsetPrior offset_prior() const;
  void measure_offset(const Alignment& alignment);
  bool accepted(const Alignment& alignment) const;
  void record(const Reference& from, int frame, const Alignment& alignment);
  void make_reference(const FrameMaps& maps, const OdometryFrame& frame);

  ImagePyramid pyramid_;
  std::optional<Reference> reference_;
  std::optional<Reference> lost_;        ///< reference of the last piece
  std::optional<RigidMotion> velocity_;  ///< from camera to camera per frame
  double offset_px_ = 0;                 ///< disparity offset at infinity, filtered
  double offset_variance_ = 0.25;        ///< pixels²; before the first link that of any rig
  bool offset_noticed_ = false;
  double usual_correlation_ = 0;  ///< of the last links
  int width_ = 0, height_ = 0;
  int pieces_ = 0;
};

void Odometry::State::require_valid(int frame, const OdometryFrame& maps) const {
  const int width = maps.grey.width(), height = maps.grey.height();
  const auto same = [&](const auto& map) { return map.width() == width && map.height() == height; };
  if (!same(maps.disparity) || !same(maps.sigma)) fail("odometry: the maps of frame ", frame, " differ in size");
  if (trajectory.frames.empty()) return;
  if (frame <= trajectory.frames.back().frame) {
    fail("odometry: frame ", frame, " comes after frame ", trajectory.frames.back().frame, "; indices must grow");
  }
  if (width != width_ || height != height_) {
    fail("odometry: frame ", frame, " has ", width, "×", height, " pixels, those before it ", width_, "×", height_);
  }
}

bool Odometry::State::accepted(const Alignment& alignment) const {
  return alignment.correlation >= options.min_correlation && alignment.overlap >= options.min_overlap;
}

/// Where the road planes of both frames agree best, whatever the motion; and no motion.
std::vector<RigidMotion> Odometry::State::starts(const Reference& from, const FrameMaps& maps,
                                                 const OdometryFrame& frame) const {
  constexpr int max_yaw_steps = 4;
  constexpr double yaw_step_rad = 2 * std::numbers::pi / 180;
  constexpr int peaks_per_yaw = 2;
  constexpr std::size_t max_starts = 6;
  std::vector<RigidMotion> result{RigidMotion{}};
  FrameRoad road;
  if (!from.road || !frame.has_road ||
      !frame_road(frame.road, calibration, frame.grey.width(), frame.grey.height(), road)) {
    return result;
  }
  const GroundGrid& fixed = from.road->grid;
  const GroundGrid grid{fixed.cell_m, road.grid.centre_x_m, road.grid.centre_y_m};
  std::vector<std::pair<double, RigidMotion>> found;
  std::vector<float> cells;
  for (int step = -max_yaw_steps; step <= max_yaw_steps; ++step) {
    const double yaw = step * yaw_step_rad;
    sample_ground(maps.pyramid, calibration, road, grid, yaw, cells);
    for (const CorrelationPeak& peak :
         phase_correlation(from.ground, spectrum(cells, GroundGrid::side), GroundGrid::side, peaks_per_yaw)) {
      const double x = peak.x * grid.cell_m - fixed.centre_x_m, y = peak.y * grid.cell_m - fixed.centre_y_m;
      const double cosine = std::cos(yaw), sine = std::sin(yaw);
      found.emplace_back(peak.height, planar_motion(*from.road, road, yaw, grid.centre_x_m + cosine * x - sine * y,
                                                    grid.centre_y_m + sine * x + cosine * y));
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (std::size_t i = 0; i < std::min(found.size(), max_starts); ++i) result.push_back(found[i].second);
  return result;
}

/// Best alignment from a prediction: from where it puts the points, or else from where their patches are found around
/// that.
Alignment Odometry::State::track(const Reference& from, const FrameMaps& maps, const RigidMotion& start) const {
  constexpr double as_usual = 0.93;  // of the correlation of the last links
  constexpr int search_radius = 6, coarsest = 1, coarsest_search = 3;
  const OffsetPrior offset = offset_prior();
  Alignment best = align(from.points, maps, calibration, start, offset, coarsest, 0);
  if (best.overlap < options.min_overlap) best.correlation = 0;
  for (int top = 1; top <= std::min(maps.pyramid.levels() - 1, coarsest_search); ++top) {
    if (best.correlation > 0 && best.correlation >= as_usual * usual_correlation_) break;
    RigidMotion motion = start;
    for (int level = top; level >= 1; --level) {
      motion = match_patches(from.points, maps, calibration, motion, offset.mean_px, level, search_radius);
    }
    const Alignment other = align(from.points, maps, calibration, motion, offset, coarsest, 0);
    if (other.correlation > best.correlation && other.overlap >= options.min_overlap) best = other;
  }
  return best;
}

std::optional<Alignment> Odometry::State::link(const Reference& from, const FrameMaps& maps, const OdometryFrame& frame,
                                               const std::optional<RigidMotion>& start) const {
  constexpr double as_before = 0.6;
  Alignment best;
  if (start) best = track(from, maps, *start);
  const double wanted = std::max(options.weak_correlation, as_before * usual_correlation_);
  if (!accepted(best) || best.correlation < wanted) {
    for (const RigidMotion& candidate : starts(from, maps, frame)) {
      const Alignment other = track(from, maps, candidate);
      if (other.correlation > best.correlation && other.overlap >= options.min_overlap) best = other;
      if (best.correlation >= wanted) break;
    }
  }
  return accepted(best) ? std::optional(best) : std::nullopt;
}

/// What is known of the offset: 0 as long as none was noticed.
OffsetPrior Odometry::State::offset_prior() const {
  if (!offset_noticed_) return {};
  return {offset_px_, std::sqrt(offset_variance_)};
}

/// Kalman filter of a random walk. An offset is noticed when it is larger than what matching itself may be off by; from
/// then on every link estimates it.
void Odometry::State::measure_offset(const Alignment& alignment) {
  if (!options.estimate_offset || !(alignment.measured_offset_sd_px > 0)) return;
  constexpr double walk_px = 0.05;   // per frame
  constexpr double spread_px = 0.1;  // of what neighbouring links of a street measure, beyond their standard errors
  constexpr double matching_bias_px = 0.06;  // of what is measured where there is none: sub-pixel bias of matching
  const double variance = alignment.measured_offset_sd_px * alignment.measured_offset_sd_px + spread_px * spread_px;
  offset_variance_ += walk_px * walk_px;
  const double gain = offset_variance_ / (offset_variance_ + variance);
  offset_px_ += gain * (alignment.measured_offset_px - offset_px_);
  offset_variance_ *= 1 - gain;
  if (std::abs(offset_px_) > matching_bias_px) offset_noticed_ = true;
}

void Odometry::State::record(const Reference& from, int frame, const Alignment& alignment) {
  FrameLink link;
  link.from = from.frame;
  link.to = frame;
  link.status = alignment.correlation < options.weak_correlation ? LinkStatus::weak : LinkStatus::good;
  link.motion = matrix_of(alignment.motion);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) link.covariance[6 * i + j] = alignment.covariance[i][j];
  }
  link.correlation = alignment.correlation;
  link.overlap = alignment.overlap;
  link.offset_px = alignment.offset_px;
  link.offset_sd_px = alignment.offset_sd_px;
  links.push_back(link);
  FramePose pose;
  pose.frame = frame;
  pose.piece = from.pose.piece;
  pose.camera_to_world = matrix_of(orthonormal(motion_of(from.pose.camera_to_world) * inverse(alignment.motion)));
  pose.covariance = carried(adjoint(alignment.motion), from.pose.covariance);
  for (std::size_t i = 0; i < pose.covariance.size(); ++i) pose.covariance[i] += link.covariance[i];
  trajectory.frames.push_back(pose);
}

void Odometry::State::make_reference(const FrameMaps& maps, const OdometryFrame& frame) {
  Reference reference;
  reference.pose = trajectory.frames.back();
  reference.frame = reference.pose.frame;
  select_points(maps, reference.points);
  FrameRoad road;
  if (frame.has_road && frame_road(frame.road, calibration, frame.grey.width(), frame.grey.height(), road)) {
    reference.road = road;
    std::vector<float> cells;
    sample_ground(maps.pyramid, calibration, road, road.grid, 0, cells);
    reference.ground = spectrum(cells, GroundGrid::side);
  }
  reference_ = std::move(reference);
}

/// Motion from the camera of the reference, by the velocity of the last frames.
RigidMotion Odometry::State::predicted(int frame) const {
  const FramePose& last = trajectory.frames.back();
  RigidMotion motion = inverse(motion_of(last.camera_to_world)) * motion_of(reference_->pose.camera_to_world);
  if (!velocity_) return orthonormal(motion);
  Twist twist = twist_of(*velocity_);
  for (double& value : twist) value *= frame - last.frame;
  return orthonormal(rigid_motion(twist) * motion);
}

const FramePose& Odometry::State::add(int frame, const OdometryFrame& maps) {
  require_valid(frame, maps);
  width_ = maps.grey.width();
  height_ = maps.grey.height();
  pyramid_.build(maps.grey);
  const FrameMaps own{pyramid_, maps.disparity, maps.sigma};
  std::optional<Alignment> alignment;
  bool is_lost = false;
  if (reference_) {
    const bool follows = trajectory.frames.back().piece == reference_->pose.piece;
    alignment = link(*reference_, own, maps, follows ? std::optional(predicted(frame)) : std::nullopt);
    if (!alignment && lost_) {
      alignment = link(*lost_, own, maps, std::nullopt);
      is_lost = alignment.has_value();
    }
  }
  if (!alignment) {
    FramePose pose;
    pose.frame = frame;
    pose.piece = pieces_++;
    trajectory.frames.push_back(pose);
    velocity_.reset();
    lost_ = std::exchange(reference_, std::nullopt);
    make_reference(own, maps);
    return trajectory.frames.back();
  }
  constexpr double memory = 0.8;
  measure_offset(*alignment);
  usual_correlation_ = usual_correlation_ > 0 ? memory * usual_correlation_ + (1 - memory) * alignment->correlation
                                              : alignment->correlation;
  if (is_lost) reference_ = std::exchange(lost_, std::nullopt);
  const FramePose before = trajectory.frames.back();
  record(*reference_, frame, *alignment);
  const FramePose& pose = trajectory.frames.back();
  velocity_.reset();
  if (before.piece == pose.piece) {
    Twist twist = twist_of(inverse(motion_of(pose.camera_to_world)) * motion_of(before.camera_to_world));
    for (double& value : twist) value /= frame - before.frame;
    velocity_ = rigid_motion(twist);
  }
  if (alignment->overlap < options.reference_overlap) make_reference(own, maps);
  return trajectory.frames.back();
}

Odometry::Odometry(const StereoCalibration& calibration, const OdometryOptions& options) {
  options.validate();
  state_ = std::make_unique<State>(calibration, options);
}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;

const FramePose& Odometry::add(int frame, const OdometryFrame& maps) {
  return state_->add(frame, maps);
}

const FramePose& Odometry::add(int frame, const FrameResult& result) {
  return add(frame, {result.grey, result.disparity, result.sigma, result.roll_found, result.geometry.plane});
}

const std::vector<FrameLink>& Odometry::links() const {
  return state_->links;
}

const Trajectory& Odometry::trajectory() const {
  return state_->trajectory;
}

}  // namespace roadstereo
