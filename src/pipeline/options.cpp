#include "roadstereo/options.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "core/edit_distance.hpp"
#include "core/shortest_text.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo {
namespace {

template <class Enum>
using Words = std::vector<std::pair<const char*, Enum>>;

const Words<ShiftPrecision>& words(ShiftPrecision) {
  static const Words<ShiftPrecision> all{{"whole_pixel", ShiftPrecision::whole_pixel},
                                         {"sub_pixel", ShiftPrecision::sub_pixel}};
  return all;
}

const Words<Scope>& words(Scope) {
  static const Words<Scope> all{{"road", Scope::road}, {"scene", Scope::scene}};
  return all;
}

const Words<WindowShape>& words(WindowShape) {
  static const Words<WindowShape> all{{"square", WindowShape::square}, {"disc", WindowShape::disc}};
  return all;
}

const Words<PeakFit>& words(PeakFit) {
  static const Words<PeakFit> all{{"parabola", PeakFit::parabola}, {"gaussian", PeakFit::gaussian}};
  return all;
}

const Words<RollSolver>& words(RollSolver) {
  static const Words<RollSolver> all{{"gradient_descent", RollSolver::gradient_descent},
                                     {"closed_form", RollSolver::closed_form},
                                     {"robust", RollSolver::robust}};
  return all;
}

/// The one list of options: calls `visit(key, member, description)` for each.
template <class Options, class Visitor>
void visit_options(Options& o, Visitor visit) {
  visit("engine", o.engine, "engine by name, or auto");
  visit("threads", o.threads, "worker threads; 0 takes all cores");
  visit("white_level", o.white_level, "sample value of white; 0: the largest of the sample type");
  visit("deblock", o.deblock, "smooth the steps between the 8×8 blocks of JPEG, where they show");
  visit("check_rows", o.check_rows, "measure whether the rows of the pair agree");
  visit("correct_rows", o.correct_rows,
        "undo the vertical shift, rotation and row scale of the right image that check_rows measures");
  visit("equalise_blur", o.equalise_blur, "smooth the sharper image of a pair of which one is blurred more");
  visit("narrow_search", o.narrow_search, "search each tile only near what the coarse search finds there");

  visit("road_model.with_roll", o.road_model.with_roll, "the model depends on the column too (a2)");
  visit("road_model.max_disparity_share", o.road_model.max_disparity_share,
        "largest disparity searched, share of the image width");
  visit("road_model.max_road_tilt_deg", o.road_model.max_road_tilt_deg, "steepest sideways tilt of a road, degrees");
  visit("road_model.min_evidence", o.road_model.min_evidence,
        "evidence for the plane, per pixel of its part of the picture, below which there is no road");
  visit("road_model.weak_evidence", o.road_model.weak_evidence,
        "evidence for the plane, per pixel of its part of the picture, below which the road is weak");
  visit("road_model.verify_tolerance_px", o.road_model.verify_tolerance_px,
        "largest residual of a tracked road model, pixels of the image shrunk to less than 1920 columns");

  visit("road_model.height_m", o.road_model.height_m,
        "expected height of the camera, metres (needs a calibration); 0: unknown");
  visit("road_model.pitch_deg", o.road_model.pitch_deg,
        "expected pitch of the camera below the horizon, degrees (needs a calibration); -90: unknown");

  visit("perspective.enabled", o.perspective.enabled, "shift the rows of the target image by the road model");
  visit("perspective.shift", o.perspective.shift, "precision of that shift");
  visit("perspective.scope", o.perspective.scope, "what is searched after the shift");
  visit("perspective.max_damage_depth_m", o.perspective.max_damage_depth_m,
        "deepest damage to be measured, metres (without a calibration below a camera 1.5 m high)");
  visit("perspective.max_bump_height_m", o.perspective.max_bump_height_m,
        "highest bump to be measured, metres (without a calibration below a camera 1.5 m high)");
  visit("perspective.disparities", o.perspective.disparities, "disparities searched after the shift; 0 derives it");
  visit("perspective.delta_p_px", o.perspective.delta_p_px,
        "the road's disparity after the shift, pixels; negative derives it");

  visit("coarse_search.factor", o.coarse_search.factor, "downsampling of the pair, 2, 4 or 8; 0 derives it");
  visit("coarse_search.block_radius", o.coarse_search.block_radius, "radius of its correlation block, coarse pixels");
  visit("coarse_search.ncc_noise_sigma", o.coarse_search.ncc_noise_sigma,
        "standard deviation of the noise in its correlation, 8-bit grey levels");
  visit("coarse_search.step_penalty", o.coarse_search.step_penalty,
        "cost of a change by one coarse pixel along the row");
  visit("coarse_search.jump_penalty", o.coarse_search.jump_penalty, "cost of a larger change along the row");
  visit("coarse_search.road_prior_height_m", o.coarse_search.road_prior_height_m,
        "height above or below the road that costs 1 (without texture; a camera that is not calibrated is 1.5 m high), "
        "metres; 0: no prior");
  visit("coarse_search.road_prior_truncation", o.coarse_search.road_prior_truncation,
        "largest cost of such a height, without texture");
  visit("coarse_search.border_height_m", o.coarse_search.border_height_m,
        "height steps within a block up to this are located by the matcher, not by the coarse search, metres; 0: none");
  visit("coarse_search.row_offset_sigma_px", o.coarse_search.row_offset_sigma_px,
        "standard error of the rows' offset, coarse pixels");
  visit("coarse_search.half_weight_sigma_px", o.coarse_search.half_weight_sigma_px,
        "standard error at which the road has half its weight, coarse pixels");

  visit("matcher.adapt_support", o.matcher.adapt_support,
        "lower blocks where the road is foreshortened, larger ones and a stronger prior where the pair is noisy");
  visit("matcher.pixel_step", o.matcher.pixel_step,
        "distance between the pixels that are matched, 1 or 2; those between are interpolated");
  visit("matcher.block_radius", o.matcher.block_radius, "radius of the correlation block, pixels");
  visit("matcher.block_aspect", o.matcher.block_aspect, "height of the correlation block over its width");
  visit("matcher.aggregation_radius", o.matcher.aggregation_radius, "radius of the bilateral window, pixels; 0 is off");
  visit("matcher.aggregation_aspect", o.matcher.aggregation_aspect, "height of the bilateral window over its width");
  visit("matcher.aggregation_step", o.matcher.aggregation_step, "distance between the window's taps, pixels");
  visit("matcher.aggregation_shape", o.matcher.aggregation_shape, "shape of the bilateral window");
  visit("matcher.sigma_space", o.matcher.sigma_space, "sigma 0 of the bilateral weights, pixels");
  visit("matcher.sigma_colour", o.matcher.sigma_colour, "sigma 1 of the bilateral weights, 8-bit grey levels");
  visit("matcher.ncc_noise_sigma", o.matcher.ncc_noise_sigma,
        "standard deviation of the noise in the correlation, 8-bit grey levels");
  visit("matcher.left_right_check", o.matcher.left_right_check,
        "check the disparities of the two views against each other");
  visit("matcher.match_both_views", o.matcher.match_both_views,
        "match the target view too, instead of projecting the winners");
  visit("matcher.prior_weight", o.matcher.prior_weight, "cost per pixel of distance from the prior; 0 ignores it");
  visit("matcher.prior_truncation_px", o.matcher.prior_truncation_px, "truncation of that distance, pixels");
  visit("matcher.lr_max_diff_px", o.matcher.lr_max_diff_px,
        "largest difference of the left-right check, pixels (delta r of eq. 12 is its square)");
  visit("matcher.occlusion_sigma_px", o.matcher.occlusion_sigma_px,
        "standard error added to what fails the left-right check, pixels; 0 makes it invalid");
  visit("matcher.sub_pixel", o.matcher.sub_pixel, "refine the winner between whole pixels");
  visit("matcher.peak_fit", o.matcher.peak_fit, "curve through the correlations around the winner");
  visit("matcher.reject_range_boundary", o.matcher.reject_range_boundary,
        "a winner at the end of its range is invalid");

  visit("refinement.passes", o.refinement.passes, "passes, each over twice the window of the last one");
  visit("refinement.radius", o.refinement.radius, "radius of the first pass's neighbours, pixels; 0 is off");
  visit("refinement.step", o.refinement.step, "distance between those neighbours, pixels");
  visit("refinement.truncation_sigmas", o.refinement.truncation_sigmas,
        "difference at which a neighbour has no weight, joint standard errors");
  visit("refinement.max_agreement_sigma_px", o.refinement.max_agreement_sigma_px,
        "upper bound on the standard error in that test, pixels");
  visit("refinement.smoothing_px", o.refinement.smoothing_px,
        "standard deviation of all averaging, pixels: on bent surfaces it adds to sigma; 0: none");
  visit("refinement.max_sigma_px", o.refinement.max_sigma_px,
        "disparities with a larger standard error are invalid, pixels");
  visit("refinement.min_sigma_px", o.refinement.min_sigma_px,
        "standard error of interpolation and calibration, pixels");

  visit("lucas_kanade.radius", o.lucas_kanade.radius,
        "radius of the window of the Lucas-Kanade step, cells of 4x4 pixels; 0 is off");
  visit("lucas_kanade.bias_sigma_px", o.lucas_kanade.bias_sigma_px,
        "expected size of the sub-pixel bias that it corrects, pixels");
  visit("lucas_kanade.max_shift_px", o.lucas_kanade.max_shift_px, "largest change of a disparity by it, pixels");

  visit(
      "off_road.max_sigma_px", o.off_road.max_sigma_px,
      "disparities off the road with a larger standard error are invalid, pixels (a third of it where the views do not "
      "correlate); 0 keeps all");

  visit("roll.solver", o.roll.solver, "solver of the roll angle");
  visit("roll.initial_lambda", o.roll.initial_lambda, "first learning rate of the descent");
  visit("roll.roll_threshold_rad", o.roll.roll_threshold_rad, "step below which the descent has converged, radians");
  visit("roll.max_iterations", o.roll.max_iterations, "largest number of steps of a solver");
  visit("roll.delta_t_px", o.roll.delta_t_px, "the road's value in the transformed map, pixels; negative derives it");
  visit("roll.max_roll_stderr_rad", o.roll.max_roll_stderr_rad,
        "the roll is observable below this standard error, radians");
  visit("roll.min_gradient_px", o.roll.min_gradient_px,
        "the roll is observable above this change of the road's disparity over the image, pixels");

  visit("damage.threshold_sigma", o.damage.threshold_sigma,
        "depth that counts as damage, standard deviations of the road");
  visit("damage.min_depth_m", o.damage.min_depth_m, "depth that counts as damage, metres (needs a calibration)");
  visit("damage.max_depth_m", o.damage.max_depth_m, "what lies deeper is a ditch, metres");
  visit("damage.max_height_m", o.damage.max_height_m, "what rises higher is a kerb or a vehicle, metres");
  visit("damage.min_area_m2", o.damage.min_area_m2, "smallest damage on the road, square metres (needs a calibration)");
  visit("damage.min_area_share", o.damage.min_area_share, "smallest damage without a calibration, share of the image");
  visit("damage.min_confidence", o.damage.min_confidence, "minimum confidence of a damage; less is a candidate");
  visit("damage.mount_yaw_deg", o.damage.mount_yaw_deg,
        "yaw of the camera relative to the direction of travel, clockwise, degrees: ruts run along the road");
  visit("damage.protrusions", o.damage.protrusions, "find bumps, heave and debris as well");
}

std::string to_text(const std::string& value) {
  return value;
}
std::string to_text(bool value) {
  return value ? "true" : "false";
}
std::string to_text(int value) {
  return std::to_string(value);
}
std::string to_text(double value) {
  return shortest_text(value);
}
template <class Enum>
requires std::is_enum_v<Enum> std::string to_text(Enum value) {
  for (const auto& [word, meaning] : words(value)) {
    if (meaning == value) return word;
  }
  return "";
}

constexpr OptionKind kind_of(bool) {
  return OptionKind::boolean;
}
constexpr OptionKind kind_of(int) {
  return OptionKind::whole;
}
constexpr OptionKind kind_of(double) {
  return OptionKind::real;
}
template <class Word>
OptionKind kind_of(const Word&) {
  return OptionKind::word;
}

[[noreturn]] void refuse(const std::string& key, const std::string& value, const std::string& wanted) {
  fail("'", value, "' is not a valid value of ", key, "; it takes ", wanted);
}

template <class Number>
void parse_number(const std::string& key, const std::string& text, const char* wanted, Number& value) {
  const char* end = text.data() + text.size();
  Number parsed{};
  const auto [stop, error] = std::from_chars(text.data(), end, parsed);
  if (error != std::errc{} || stop != end || text.empty()) refuse(key, text, wanted);
  value = parsed;
}

void parse(const std::string&, const std::string& text, std::string& value) {
  value = text;
}
void parse(const std::string& key, const std::string& text, int& value) {
  parse_number(key, text, "a whole number", value);
}
void parse(const std::string& key, const std::string& text, double& value) {
  parse_number(key, text, "a number", value);
}
void parse(const std::string& key, const std::string& text, bool& value) {
  if (text == "true" || text == "1" || text == "on" || text == "yes") {
    value = true;
  } else if (text == "false" || text == "0" || text == "off" || text == "no") {
    value = false;
  } else {
    refuse(key, text, "true or false");
  }
}
template <class Enum>
requires std::is_enum_v<Enum>
void parse(const std::string& key, const std::string& text, Enum& value) {
  std::string wanted;
  for (const auto& [word, meaning] : words(value)) {
    if (text == word) {
      value = meaning;
      return;
    }
    wanted += (wanted.empty() ? "" : " or ") + std::string(word);
  }
  refuse(key, text, wanted);
}

/// The known key that was probably meant: compared whole, and without its group, since people forget that.
std::string nearest_key(const PipelineOptions& options, const std::string& key) {
  std::string nearest;
  std::size_t smallest = std::string::npos;
  visit_options(options, [&](const std::string& known, const auto&, const char*) {
    const std::string name = known.substr(known.find('.') + 1);
    const std::size_t distance = std::min(edit_distance(key, known), edit_distance(key, name));
    if (distance < smallest) {
      smallest = distance;
      nearest = known;
    }
  });
  return nearest;
}

}  // namespace

std::vector<OptionText> list_options(const PipelineOptions& options) {
  std::vector<OptionText> list;
  visit_options(options, [&](const char* key, const auto& value, const char* description) {
    list.push_back({key, to_text(value), description, kind_of(value)});
  });
  return list;
}

void set_option(PipelineOptions& options, const std::string& key, const std::string& value) {
  bool found = false;
  visit_options(options, [&](const char* known, auto& member, const char*) {
    if (key != known) return;
    parse(key, value, member);
    found = true;
  });
  if (!found) fail("there is no option called '", key, "'; the nearest is '", nearest_key(options, key), "'");
}

}  // namespace roadstereo
