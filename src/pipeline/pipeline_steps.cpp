#include "pipeline/pipeline_steps.hpp"

#include <algorithm>
#include <limits>

#include "core/format_message.hpp"
#include "core/noise_correlation.hpp"
#include "pipeline/blur_correction.hpp"
#include "road/rig_prior.hpp"
#include "road/road_assessment.hpp"
#include "road/row_shift.hpp"
#include "stereo/adaptive_support.hpp"
#include "stereo/coarse/coarse_size.hpp"

namespace roadstereo {

GreyPair Pipeline::State::convert_to_grey(const FrameView& left, const FrameView& right) {
  const StageTimer timer(result.ms.prepare);
  GreyPair pair = stages->convert_to_grey(left, right, options.white_level);
  pair.mask = mask;
  return pair;
}

/// The pair with equal blur: at an edge that one lens blurs more, such as a shadow's, blocks on either side of it would
/// match with errors of opposite sign.
GreyPair Pipeline::State::equalise_blur(const GreyPair& pair) {
  result.blur = {};
  result.smoothed_px2 = 0;
  if (!options.equalise_blur) return pair;
  const StageTimer timer(result.ms.prepare);
  if (blur_is_due(carried)) {
    const GreyPair on_host = stages->on_host(pair);
    result.blur = measure_blur_difference(on_host.left, on_host.right, threads, mask);
    update_blur(result.blur, carried);
  }
  result.smoothed_px2 = carried.blur_px2;
  if (carried.blur_px2 == 0) return pair;
  GreyPair equal = stages->smooth(pair, carried.blur_px2);
  equal.mask = pair.mask;
  return equal;
}

/// The pair with aligned rows, for the road model: at an edge along the rows, an offset of the rows becomes a disparity
/// error of pixels.
GreyPair Pipeline::State::undo_misalignment(const GreyPair& pair) {
  if (carried.misalignment.is_zero()) return pair;
  GreyPair aligned = stages->undo_misalignment(pair, carried.misalignment);
  aligned.mask = pair.mask;
  return aligned;
}

/// The same for a pair in host memory, on the host, since a device rounds a few grey levels differently: one
/// correspondence more or less would make RANSAC draw other samples, and could move the correlation across the limit
/// between two block sizes.
GreyPair Pipeline::State::align_on_host(const GreyPair& pair) {
  if (carried.misalignment.is_zero()) return pair;
  transform_target(pair.right, without_road(carried.misalignment), threads, aligned_right, first_column);
  return {pair.left, aligned_right, pair.mask};
}

/// What is so far that its disparity is negative, since the right camera looks inwards, is not searched.
void Pipeline::State::warn_of_negative_disparities() {
  constexpr double noteworthy_px = 1;
  if (!calibration || calibration->disparity_offset_px <= noteworthy_px) return;
  const double offset = calibration->disparity_offset_px;
  result.warnings.push_back(format_message(
      "negative-disparities: the disparity offset of the calibration is ", offset, " px, so that what is farther than ",
      calibration->focal_px * calibration->baseline_m / offset, " m has a negative disparity and is not searched"));
}

/// Road model Δu, eq. (4): the last frame's when it still fits, else from the images.
void Pipeline::State::estimate_road_model(const GreyPair& pair) {
  const StageTimer timer(result.ms.road_model);
  const RigPrior expected(options.road_model, calibration);
  warn_of_negative_disparities();
  result.rows = {};
  if (carried.road) {
    if (options.check_rows && rows_are_due(carried)) measure_rows(stages->on_host(pair), Rows::of_tracked_road);
    result.road = stages->verify_road_model(undo_misalignment(pair), *carried.road);
    if (!result.road.has_road()) track_in_noise(align_on_host(stages->on_host(pair)));
    if (result.road.has_road() && expected.disagreement(result.road.model).empty()) return;
    if (result.road.has_road()) result.road.reason = "the last frame's road has another pose than expected";
    result.warnings.push_back(format_message("road-anew: the road was searched again: ", result.road.reason));
  }
  const GreyPair on_host = stages->on_host(pair);
  if (options.check_rows) measure_rows(on_host, Rows::of_new_road);
  const GreyPair grey = align_on_host(on_host);
  // A plane with another pose than expected is what the search is to replace.
  const bool is_expected = carried.road && expected.disagreement(carried.road->model).empty();
  const auto last = is_expected ? std::optional(carried.road->model) : std::nullopt;
  result.road =
      roadstereo::estimate_road_model(grey.left, grey.right, calibration, options.road_model, threads, mask, last);
  if (!result.road.has_road()) {
    result.warnings.push_back(format_message("no-road: no road was found (", result.road.reason,
                                             "): the pair was matched without perspective transformation, over the "
                                             "disparities that it shows, at most a quarter of the width"));
  } else if (result.road.status == RoadStatus::weak) {
    std::string reason = result.road.reason;
    if (reason.empty()) {
      reason = format_message("the evidence for it is ", result.road.evidence, " per pixel, less than ",
                              options.road_model.weak_evidence);
    }
    result.warnings.push_back("weak-road: the road is weak: " + reason);
  }
  if (result.road.has_road()) {
    const std::string disagreement = expected.disagreement(result.road.model);
    if (!disagreement.empty()) result.warnings.push_back("unexpected-pose: " + disagreement);
  }
}

/// If single blocks do not find the last frame's road, cells of blocks may.
void Pipeline::State::track_in_noise(const GreyPair& pair) {
  const RoadModelEstimate tracked =
      verify_road_model_in_noise(pair.left, pair.right, *carried.road, calibration, options.road_model, threads, mask);
  if (tracked.has_road()) result.road = tracked;
}

/// Measures the vertical offset of the pair, once a frame: the road may have been lost after it.
void Pipeline::State::measure_rows(const GreyPair& grey, Rows of) {
  if (result.rows.points == 0) result.rows = measure_row_alignment(grey.left, grey.right, threads, mask);
  update_misalignment(result.rows, of, options.correct_rows, calibration, carried);
  const std::string warning = row_warning(result.rows, of);
  if (!warning.empty() && std::ranges::find(result.warnings, warning) == result.warnings.end()) {
    result.warnings.push_back(warning);
  }
}

/// Perspective transformation π_tar → π_tar', section 3.1.
MatchInput Pipeline::State::transform_perspective(const GreyPair& pair) {
  const StageTimer timer(result.ms.perspective);
  result.shift = plan_perspective(result.road, calibration, width, height, options.perspective);
  result.shift.misalignment = carried.misalignment;
  return stages->transform_perspective(pair, result.shift);
}

/// The coarse search at a given size, with blocks for the noise that is left there. In a scene the road is one surface
/// of many: its prior has less weight. Frames of KITTI: with 1.5 the disparities off the road are pulled to it, with
/// 0 one in a hundred on the road is lost.
CoarseSearchOptions Pipeline::State::coarse_options(int factor, int block_radius) const {
  constexpr double max_truncation_of_scene = 0.3;
  CoarseSearchOptions coarse = options.coarse_search;
  if (options.perspective.scope == Scope::scene) {
    coarse.road_prior_truncation = std::min(coarse.road_prior_truncation, max_truncation_of_scene);
  }
  if (options.matcher.prior_weight == 0) coarse.border_height_m = 0;  // nobody reads intervals
  coarse.factor = factor;
  coarse.block_radius = options.matcher.adapt_support
                            ? adapt_radius(block_radius, downsampled_correlation(result.road.correlation, factor))
                            : block_radius;
  return coarse;
}

/// Disparity ranges of the tiles, and the prior of the matcher.
MatchInput Pipeline::State::search_coarsely(const MatchInput& pair) {
  const StageTimer timer(result.ms.coarse);
  const int factor =
      factor_with_fractions(coarse_factor(options.coarse_search, width, pair.disparities), pair.disparities);
  return stages->search_coarsely(pair, result.shift, coarse_options(factor, options.coarse_search.block_radius));
}

/// Without a calibration the focal length is taken for the width of the image.
double Pipeline::State::road_foreshortening() const {
  if (!result.shift.enabled) return 1;
  const double focal_px = calibration ? calibration->focal_px : width,
               cy_px = calibration ? calibration->cy_px : height / 2.0;
  DisparityPlane road = result.road.model;
  road.a0 += result.shift.disparity_offset_px;  // 0 at infinity
  return foreshortening(road, focal_px, cy_px, width, height);
}

/// Costs, eq. (8), bilateral aggregation, eq. (11), winner-take-all, left-right check, eq. (12), and sub-pixel
/// disparity, eq. (13): section 3.2. Masked pixels have no disparity. Without a road model the prior rests on its rows
/// alone, and its truncation is smaller.
ResidualMaps Pipeline::State::match(const MatchInput& input) {
  constexpr double truncation_without_road_px = 2;
  const StageTimer timer(result.ms.match);
  MatcherOptions matcher = adapt_support(options.matcher, {result.road.correlation, road_foreshortening()});
  if (!result.shift.enabled) {
    matcher.prior_truncation_px = std::min(matcher.prior_truncation_px, truncation_without_road_px);
  }
  const ResidualMaps maps = stages->match(input, matcher);
  leave_out_mask(maps.disparity, maps.pixel_step);
  return maps;
}

void Pipeline::State::leave_out_mask(ImageView<float> map, int pixel_step) const {
  if (mask.empty()) return;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      if (mask(x * pixel_step, y * pixel_step) != 0) map(x, y) = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

/// Adds Δu − δp back. The left-right check of `match` needs no shift: it cancels there.
DisparityMaps Pipeline::State::restore_disparity(const ResidualMaps& residual) {
  const StageTimer timer(result.ms.refinement);
  return stages->restore_disparity(residual, result.shift);
}

RefinedMaps Pipeline::State::refine(const DisparityMaps& maps) {
  const StageTimer timer(result.ms.refinement);
  result.smoothing_px = options.refinement.smoothing_px;
  return stages->refine(maps, result.shift.road);
}

/// Pixels between those that were matched.
ImageView<const float> Pipeline::State::interpolate(const RefinedMaps& maps) {
  const StageTimer timer(result.ms.refinement);
  const InterpolatedMaps interpolated = stages->interpolate(maps, result.shift.road);
  leave_out_mask(interpolated.disparity, 1);
  leave_out_mask(interpolated.sigma, 1);
  return interpolated.disparity;
}

/// A Lucas–Kanade step undoes the rest of pixel locking.
ImageView<const float> Pipeline::State::align(const MatchInput& input, ImageView<const float> disparity) {
  const StageTimer timer(result.ms.refinement);
  return stages->align(input, disparity, result.shift, mask);
}

/// Whether only disparities near the road are searched: those of other things are wrong then.
bool Pipeline::State::searches_road_alone() const {
  return result.shift.enabled && options.perspective.scope == Scope::road && options.off_road.max_sigma_px > 0 &&
         options.lucas_kanade.radius > 0;
}

/// Disparities of everything that the image shows, without the road as prior and with the smallest blocks, since this
/// search is to find what is not road.
DisparityPriorView Pipeline::State::search_scene(const MatchInput& pair) {
  constexpr int max_factor = 8, block_radius = 1;
  if (!searches_road_alone()) return {};
  const StageTimer timer(result.ms.coarse);
  MatchInput whole = pair;
  whole.disparities = scene_disparities(result.shift, width, height);
  const int factor = 2 * coarse_factor(options.coarse_search, width, whole.disparities);
  CoarseSearchOptions coarse = coarse_options(std::min(max_factor, factor), block_radius);
  coarse.road_prior_height_m = 0;
  return stages->search_scene(whole, result.shift, coarse);
}

/// Removes wrong disparities beside the road. If the horizon of the road is not in the image, the camera looks down on
/// the road, which may fill the image: unconfirmed disparities are then noisy road, and only those that the scene
/// contradicts are removed.
ImageView<const float> Pipeline::State::reject_off_road(ImageView<const float> disparity,
                                                        const DisparityPriorView& scene) {
  constexpr double any_sigma_px = 10;
  const StageTimer timer(result.ms.refinement);
  if (scene.disparity.empty()) return disparity;
  const DisparityPlane& road = result.shift.road;
  const double at_infinity = -result.shift.disparity_offset_px;
  const bool horizon_in_picture = std::min(road.disparity(0, 0), road.disparity(width - 1, 0)) < at_infinity;
  OffRoadOptions off_road = options.off_road;
  if (!horizon_in_picture) off_road.max_sigma_px = any_sigma_px;
  return stages->reject_off_road(disparity, scene, result.shift, off_road, mask);
}

ImageView<const float> Pipeline::State::subtract_bias(ImageView<const float> disparity) {
  const StageTimer timer(result.ms.refinement);
  return stages->subtract_bias(disparity, options.rig_bias);
}

/// Roll angle ψ of the least E_t, eq. (23), and projection model, section 3.3.
void Pipeline::State::estimate_roll(ImageView<const float> disparity) {
  // A pair without a road has no results except its disparities.
  constexpr double min_valid_share = 0.01;
  const StageTimer timer(result.ms.roll);
  const bool has_road = result.road.has_road();
  const auto prior = has_road ? std::optional(result.road.model) : std::nullopt;
  const RollFit fit = stages->estimate_roll(disparity, prior, carried.roll_rad, min_valid_share, result.shift);
  result.valid_share = fit.valid_share;
  result.roll_found = fit.geometry.has_value();
  result.geometry = fit.geometry.value_or(RollEstimate{});
  // Where hardly any road is in view the fit may have left it.
  if (result.roll_found && has_road &&
      !TiltLimit(width, height, calibration, options.road_model.max_road_tilt_deg).can_be_road(result.geometry.plane)) {
    result.roll_found = false;
    result.geometry = {};
    result.road.status = RoadStatus::none;
    result.road.reason = "the plane through the disparities is tilted like a wall";
    result.warnings.push_back("tilted-road: " + result.road.reason);
    return;
  }
  if (has_road && !result.roll_found) {
    const char* const lacking =
        result.valid_share < min_valid_share ? "" : ": too few for a road geometry, or all on one line of the image";
    result.warnings.push_back(format_message("few-disparities: only ", 100 * result.valid_share,
                                             " % of the pixels have a disparity", lacking));
  }
}

/// Disparity transformation ℓ → ℓ', eq. (29). δt is at least δp, so that it stays the same from frame to frame.
void Pipeline::State::transform_disparity(ImageView<const float> disparity) {
  const StageTimer timer(result.ms.transform);
  result.delta_t = 0;
  result.spread = {};
  if (!result.roll_found) {
    stages->invalidate_transformed();
    return;
  }
  const TransformedRoad road = stages->transform_disparity(disparity, result.geometry, result.shift);
  result.delta_t = road.delta_t;
  result.spread = road.spread;
}

void Pipeline::State::download() {
  const StageTimer timer(result.ms.download);
  stages->download(result);
}

}  // namespace roadstereo
