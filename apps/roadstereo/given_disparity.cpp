#include "given_disparity.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "roadstereo/error.hpp"
#include "stopwatch.hpp"

namespace roadstereo::cli {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Makes values invalid that no point in front of the cameras has, and masked ones. Returns the share of the others.
double invalidate(const Inspection& inspection, Image<float>& disparity) {
  const double offset_px = inspection.pair.calibration ? inspection.pair.calibration->disparity_offset_px : 0;
  std::size_t valid = 0;
  for (int v = 0; v < disparity.height(); ++v) {
    for (int u = 0; u < disparity.width(); ++u) {
      float& d = disparity(u, v);
      const bool masked = !inspection.mask.empty() && inspection.mask(u, v) != 0;
      if (masked || !std::isfinite(d) || d + offset_px <= 0) d = nan;
      valid += std::isnan(d) ? 0U : 1U;
    }
  }
  return static_cast<double>(valid) / static_cast<double>(disparity.pixels());
}

RoadModelEstimate road_of_pair(const Inspection& inspection) {
  const PipelineOptions& options = inspection.options;
  return estimate_road_model(inspection.result.grey, inspection.result.right, inspection.pair.calibration,
                             options.road_model, options.threads, inspection.mask);
}

/// Estimates the roll, from the plane of the pair's road if there is a right image.
void estimate_geometry(const Inspection& inspection, FrameResult& result) {
  const bool has_right = !inspection.pair.right.bytes.empty();
  if (has_right) {
    to_grey(inspection.pair.right.view(), inspection.options.white_level, result.right);
    result.road = road_of_pair(inspection);
  }
  if (has_right && !result.road.has_road()) return;
  const auto prior = has_right ? std::optional(result.road.model) : std::nullopt;
  try {
    result.geometry =
        estimate_roll(result.disparity, {}, prior, 0, inspection.options.roll, inspection.options.threads);
  } catch (const Error& error) {
    result.road = {};
    result.road.reason = error.what();
    return;
  }
  result.roll_found = true;
  if (has_right) return;
  result.road.model = result.geometry.plane;
  result.road.status = RoadStatus::found;
  result.road.residual_px = result.geometry.residual_px;
}

void fill_result(Inspection& inspection) {
  const PipelineOptions& options = inspection.options;
  FrameResult& result = inspection.result;
  to_grey(inspection.pair.left.view(), options.white_level, result.grey);
  result.disparity = std::move(inspection.pair.disparity);
  result.mask = inspection.mask;
  result.valid_share = invalidate(inspection, result.disparity);
  estimate_geometry(inspection, result);
  if (result.roll_found) {
    result.delta_t =
        transform_disparity(result.disparity, result.geometry, 0, options.roll, options.threads, result.transformed);
    result.spread = measure_residuals(result.transformed, result.delta_t, options.threads);
  } else {
    result.transformed.assign(result.disparity.width(), result.disparity.height(), nan);
    result.warnings.push_back("no-road: no road was found: " + result.road.reason);
  }
}

}  // namespace

void use_given_disparity(Inspection& inspection) {
  inspection.result.ms.total = time_ms([&] { fill_result(inspection); });
}

}  // namespace roadstereo::cli
