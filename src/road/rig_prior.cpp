#include "road/rig_prior.hpp"

#include <cmath>

#include "core/degrees.hpp"
#include "core/format_message.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/ground_plane.hpp"

namespace roadstereo {
namespace {

// A tape measure and a loaded vehicle are that exact.
constexpr double height_tolerance = 0.2;  ///< share of the height
constexpr double pitch_tolerance_deg = 5;

}  // namespace

RigPrior::RigPrior(const RoadModelOptions& options, const std::optional<StereoCalibration>& calibration)
    : calibration_(calibration) {
  if (options.height_m > 0) height_m_ = options.height_m;
  if (options.pitch_deg > unknown_pitch_deg) pitch_deg_ = options.pitch_deg;
  if (*this && !calibration_) fail("the expected height and pitch of the camera need a calibration");
}

double RigPrior::weight(const DisparityPlane& plane) const {
  if (!*this) return 1;
  const GroundPlane ground = ground_plane(plane, *calibration_);
  const double height = height_m_ ? (ground.height_m / *height_m_ - 1) / height_tolerance : 0;
  const double pitch = pitch_deg_ ? (to_degrees(ground.pitch_rad) - *pitch_deg_) / pitch_tolerance_deg : 0;
  return 1 / (1 + height * height + pitch * pitch);
}

std::string RigPrior::disagreement(const DisparityPlane& plane) const {
  if (!*this) return {};
  const GroundPlane ground = ground_plane(plane, *calibration_);
  if (height_m_ && std::abs(ground.height_m / *height_m_ - 1) > height_tolerance) {
    return format_message("the camera is ", ground.height_m, " m above the road that was found, not ", *height_m_,
                          " m as expected");
  }
  const double pitch = to_degrees(ground.pitch_rad);
  if (pitch_deg_ && std::abs(pitch - *pitch_deg_) > pitch_tolerance_deg) {
    return format_message("the pitch of the camera is ", pitch, "° relative to the road that was found, not ",
                          *pitch_deg_, "° as expected");
  }
  return {};
}

}  // namespace roadstereo
