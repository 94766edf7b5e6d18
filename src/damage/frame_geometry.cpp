#include "damage/frame_geometry.hpp"

#include <cmath>
#include <vector>

#include "core/order_statistics.hpp"
#include "roadstereo/perspective_shift.hpp"

namespace roadstereo {
namespace {

/// Estimate δt of ℓ' = ℓ − road + δt (eq. (29), disparity_transformation): median over every seventh pixel and row.
double estimate_delta_t(const DamageInput& input) {
  constexpr int step = 7;
  std::vector<double> deltas;
  for (int v = step / 2; v < input.disparity.height(); v += step) {
    for (int u = step / 2; u < input.disparity.width(); u += step) {
      const double delta =
          static_cast<double>(input.transformed(u, v)) - input.disparity(u, v) + input.plane->disparity(u, v);
      if (std::isfinite(delta)) deltas.push_back(delta);
    }
  }
  return deltas.empty() ? 0 : upper_median(deltas);
}

}  // namespace

StereoCalibration assumed_calibration(const DisparityPlane& model, int width, int height) {
  StereoCalibration assumed;
  assumed.focal_px = width;
  assumed.cx_px = 0.5 * (width - 1);
  assumed.cy_px = 0.5 * (height - 1);
  const double at_centre = model.disparity(assumed.cx_px, assumed.cy_px) / assumed.focal_px;
  assumed.baseline_m = PerspectiveShift::assumed_camera_height_m * std::hypot(model.a1, model.a2, at_centre);
  return assumed;
}

FrameGeometry::FrameGeometry(const DamageInput& input)
    : calibration_(input.calibration.value_or(
          assumed_calibration(*input.plane, input.transformed.width(), input.transformed.height()))),
      disparity_plane_(*input.plane),
      ground_plane_(ground_plane(*input.plane, calibration_)),
      axes_(road_axes(ground_plane_)),
      delta_t_(estimate_delta_t(input)) {}

void FrameGeometry::depths_to_metres(int v, int width, const float* surface, float* depths) const {
  // On the line of sight of a pixel n·P = h·D / (d + doffs), with D = d + doffs of the plane at that pixel.
  const auto height = static_cast<float>(ground_plane_.height_m);
  const auto first = static_cast<float>(disparity_plane_.disparity(0, v) + calibration_.disparity_offset_px);
  const auto slope = static_cast<float>(disparity_plane_.a2);
  const auto delta_t = static_cast<float>(delta_t_);
  for (int u = 0; u < width; ++u) {
    const float plane = first + slope * static_cast<float>(u);
    const float road = plane + (surface[u] - delta_t);
    depths[u] *= height * plane / (road * (road - depths[u]));
  }
}

}  // namespace roadstereo
