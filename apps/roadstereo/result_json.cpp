#include "result_json.hpp"

#include <nlohmann/json.hpp>

#include "finite_values.hpp"
#include "health_json.hpp"
#include "json_text.hpp"
#include "roadstereo/options.hpp"
#include "roadstereo/version.hpp"
#include "roadstereo/warning.hpp"

namespace roadstereo::cli {

namespace {

using Json = nlohmann::ordered_json;

Json inputs_json(const PairFiles& files, const std::string& mask, const std::string& rig_bias) {
  Json calibration = nullptr;
  if (!files.calibration.empty()) calibration = files.calibration;
  return {{"left", files.left},
          {"right", files.right.empty() ? Json(nullptr) : Json(files.right)},
          {"disparity", files.disparity.empty() ? Json(nullptr) : Json(files.disparity)},
          {"calibration", calibration},
          {"mask", mask.empty() ? Json(nullptr) : Json(mask)},
          {"rig_bias", rig_bias.empty() ? Json(nullptr) : Json(rig_bias)}};
}

/// Converts the text of an option to a number, boolean or string.
Json option_value(const OptionText& option) {
  if (option.kind == OptionKind::word) return option.value;
  Json value = Json::parse(option.value, nullptr, false);
  return value.is_discarded() ? Json(option.value) : value;
}

Json calibration_json(const StereoPair& pair) {
  if (!pair.calibration) return nullptr;
  const StereoCalibration& rig = *pair.calibration;
  return {{"format", pair.calibration_format},
          {"rectified_here", pair.rectified_here},
          {"focal_px", json_number(rig.focal_px)},
          {"cx_px", json_number(rig.cx_px)},
          {"cy_px", json_number(rig.cy_px)},
          {"baseline_m", json_number(rig.baseline_m)},
          {"disparity_offset_px", json_number(rig.disparity_offset_px)}};
}

Json model_json(const DisparityPlane& model) {
  return {{"a0", json_number(model.a0)}, {"a1", json_number(model.a1)}, {"a2", json_number(model.a2)}};
}

Json estimate_json(const RoadModelEstimate& road) {
  Json estimate = {{"status", name_of(road.status)}, {"reason", road.reason}};
  estimate["evidence"] = json_number(road.evidence);
  estimate["inlier_share"] = json_number(road.inlier_share);
  estimate["correlation"] = json_number(road.correlation);
  estimate["model"] = road.has_road() ? model_json(road.model) : Json(nullptr);
  estimate["matches"] = road.matches;
  estimate["inliers"] = road.inliers;
  estimate["residual_px"] = road.has_road() ? json_number(road.residual_px) : Json(nullptr);
  return estimate;
}

Json rows_json(const RowAlignment& rows, const Misalignment& undone) {
  const bool known = rows.known();
  return {{"median_px", known ? json_number(rows.median_px) : Json(nullptr)},
          {"sigma_px", known ? json_number(rows.sigma_px) : Json(nullptr)},
          {"points", rows.points},
          {"undone",
           {{"rows_px", json_number(undone.rows_px)},
            {"turn_rad", json_number(undone.turn_rad)},
            {"row_scale", json_number(undone.row_scale)}}}};
}

Json blur_json(const FrameResult& result) {
  const bool known = result.blur.known();
  return {{"difference_px2", known ? json_number(result.blur.variance_px2) : Json(nullptr)},
          {"stderr_px2", known ? json_number(result.blur.stderr_px2) : Json(nullptr)},
          {"smoothed_px2", json_number(result.smoothed_px2)}};
}

Json times_json(const StageTimes& ms) {
  return {{"prepare", json_number(ms.prepare)},
          {"road_model", json_number(ms.road_model)},
          {"perspective", json_number(ms.perspective)},
          {"coarse", json_number(ms.coarse)},
          {"match", json_number(ms.match)},
          {"refinement", json_number(ms.refinement)},
          {"roll", json_number(ms.roll)},
          {"transform", json_number(ms.transform)},
          {"download", json_number(ms.download)},
          {"total", json_number(ms.total)}};
}

void add_geometry(Json& document, const FrameResult& result) {
  const RollEstimate& geometry = result.geometry;
  const auto known = [&](double value) { return result.roll_found ? json_number(value) : Json(nullptr); };
  document["road_model"] = result.roll_found ? model_json(geometry.plane) : Json(nullptr);
  document["alpha0"] = known(geometry.alpha0);
  document["alpha1"] = known(geometry.alpha1);
  document["roll_rad"] = known(geometry.roll_rad);
  document["roll_stderr_rad"] = known(geometry.roll_stderr_rad);
  document["roll_observable"] = result.roll_found && geometry.roll_observable;
  document["residual_px"] = known(geometry.residual_px);
  document["delta_p"] = json_number(result.shift.delta_p);
  document["delta_t"] = known(result.delta_t);
  document["disparities"] = result.shift.disparities;
  document["valid_fraction"] = json_number(result.valid_share);
  document["sigma_px"] = json_number(median(finite_values(result.sigma)));
  document["sigma_d_px"] = known(result.spread.sigma_road_px);
  document["sigma_d_all_px"] = known(result.spread.sigma_all_px);
  document["road_fraction"] = known(result.spread.road_share);
}

void add_plane(Json& document, const std::optional<GroundPlane>& plane) {
  document["camera_height_m"] = plane ? json_number(plane->height_m) : Json(nullptr);
  document["camera_pitch_rad"] = plane ? json_number(plane->pitch_rad) : Json(nullptr);
}

}  // namespace

Json options_json(const PipelineOptions& options) {
  Json list = Json::object();
  for (const OptionText& option : list_options(options)) list[option.key] = option_value(option);
  return list;
}

std::string result_json(const Inspection& inspection) {
  const FrameResult& result = inspection.result;
  Json document = {{"version", version},
                   {"inputs", inputs_json(inspection.files, inspection.mask_file, inspection.rig_bias_file)}};
  document["size"] = {{"width", result.disparity.width()}, {"height", result.disparity.height()}};
  document["preset"] = inspection.preset;
  document["options"] = options_json(inspection.options);
  document["engine"] = inspection.engine.empty() ? Json(nullptr) : Json(inspection.engine);
  document["threads"] = inspection.threads;
  document["calibration"] = calibration_json(inspection.pair);
  add_geometry(document, result);
  add_plane(document, inspection.plane);
  document["damages"] = inspection.damage.damages.size();  // each is in damages.json
  document["road_noise_px"] = json_number(inspection.damage.noise_px);
  document["rows"] = rows_json(result.rows, result.shift.misalignment);
  document["blur"] = blur_json(result);
  document["health"] = health_json(inspection.health);
  document["road"] = estimate_json(result.road);
  document["ms"] = times_json(result.ms);
  document["mde_per_s"] = json_number(result.mde_per_s);
  document["warnings"] = inspection.warnings;
  document["warning_codes"] = Json::array();
  for (const std::string& warning : inspection.warnings) document["warning_codes"].push_back(warning_code(warning));
  for (const auto& [name, what] : inspection.files_written) document["files"][name] = what;
  return json_text(document);
}

}  // namespace roadstereo::cli
