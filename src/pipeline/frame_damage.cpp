#include <cmath>
#include <limits>
#include <vector>

#include "road/black_border.hpp"
#include "road/rig_bias_field.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/pipeline.hpp"

namespace roadstereo {
namespace {

/// Removes masked pixels from damages, since the depth under a mask is interpolated, and damages of which half of the
/// pixels or fewer remain. The others are renumbered in their order.
void remove_masked(const FrameResult& frame, DamageMap& map) {
  if (frame.mask.empty() || map.damages.empty()) return;
  std::vector<std::size_t> seen(map.damages.size() + 1);
  for (int v = 0; v < map.ids.height(); ++v) {
    for (int u = 0; u < map.ids.width(); ++u) {
      if (frame.mask(u, v) == 0) ++seen[map.ids(u, v)];
    }
  }
  const std::size_t before = map.damages.size();
  std::vector<std::uint16_t> new_ids(before + 1, 0);
  std::erase_if(map.damages,
                [&](const Damage& damage) { return 2 * seen[static_cast<std::size_t>(damage.id)] <= damage.pixels; });
  for (std::size_t k = 0; k < map.damages.size(); ++k) {
    int& id = map.damages[k].id;
    new_ids[static_cast<std::size_t>(id)] = static_cast<std::uint16_t>(k + 1);
    id = static_cast<int>(k + 1);
  }
  for (Damage& candidate : map.candidates) candidate.id -= static_cast<int>(before - map.damages.size());
  for (int v = 0; v < map.ids.height(); ++v) {
    for (int u = 0; u < map.ids.width(); ++u) {
      std::uint16_t& id = map.ids(u, v);
      if (id == 0) continue;
      const bool is_masked = frame.mask(u, v) != 0;
      id = is_masked ? 0 : new_ids[id];
      if (id != 0) continue;
      if (is_masked) map.road(u, v) = 0;
      if (std::isnan(frame.transformed(u, v))) map.depth(u, v) = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

/// The disparities between the images.
Image<float> with_bias(ImageView<const float> disparity, const RigBias& bias) {
  Image<float> matched(disparity.width(), disparity.height());
  const BiasPolynomial<float> field = bias_polynomial<float>(bias);
  for (int v = 0; v < disparity.height(); ++v) {
    const BiasRow<float> row = field.row(static_cast<float>(v));
    for (int u = 0; u < disparity.width(); ++u) matched(u, v) = disparity(u, v) + row.at(static_cast<float>(u));
  }
  return matched;
}

}  // namespace

DamageMap find_damage(const FrameResult& frame, const std::optional<StereoCalibration>& calibration,
                      const DamageOptions& options, int threads) {
  DamageMap result;
  find_damage(frame, calibration, options, threads, result);
  return result;
}

void find_damage(const FrameResult& frame, const std::optional<StereoCalibration>& calibration,
                 const DamageOptions& options, int threads, DamageMap& result) {
  if (frame.disparity.empty()) {
    fail(
        "the frame has no maps on the host, which damage detection needs: no pair was processed, or the maps were left "
        "on the device");
  }
  if (!frame.roll_found) {
    result = make_empty_damage_map(frame.disparity.width(), frame.disparity.height(),
                                   frame.road.has_road() ? "too few disparities of the road" : "no road was found");
    return;
  }
  DamageInput input;
  input.transformed = frame.transformed;
  input.disparity = frame.disparity;
  Image<float> matched;
  if (frame.rig_bias) {
    matched = with_bias(frame.disparity, *frame.rig_bias);
    input.matched = matched;
  }
  input.sigma = frame.sigma;
  input.smoothing_px = frame.smoothing_px;
  input.grey = frame.grey;
  input.right = frame.right;
  const PictureMask mask(frame.grey, frame.mask);
  input.mask = mask.view();
  if (!frame.sigma.empty()) input.shift = frame.shift;  // a given map has neither errors nor a range searched
  input.plane = frame.geometry.plane;
  input.calibration = calibration;
  find_damage(input, options, threads, result);
  remove_masked(frame, result);
}

}  // namespace roadstereo
