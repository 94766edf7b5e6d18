#include "truth_json.hpp"

#include <nlohmann/json.hpp>

#include "json_text.hpp"
#include "roadstereo/version.hpp"

namespace roadstereo::cli {

namespace {

using Json = nlohmann::ordered_json;

Json rig_json(const synth::Rig& rig) {
  return {{"width", rig.width},
          {"height", rig.height},
          {"focal_px", json_number(rig.focal_px)},
          {"baseline_m", json_number(rig.baseline_m)},
          {"x_m", json_number(rig.x_m)},
          {"y_m", json_number(rig.y_m)},
          {"camera_height_m", json_number(rig.camera_height_m)},
          {"pitch_deg", json_number(rig.pitch_deg)},
          {"roll_deg", json_number(rig.roll_deg)},
          {"yaw_deg", json_number(rig.yaw_deg)}};
}

Json degradation_json(const synth::Degradation& wear) {
  return {{"noise_grey", json_number(wear.noise_grey)},
          {"blur_px", json_number(wear.blur_px)},
          {"motion_blur_px", json_number(wear.motion_blur_px)},
          {"motion_blur_angle_deg", json_number(wear.motion_blur_angle_deg)},
          {"gain_difference", json_number(wear.gain_difference)},
          {"exposure", json_number(wear.exposure)},
          {"row_offset_px", json_number(wear.row_offset_px)},
          {"row_rotation_deg", json_number(wear.row_rotation_deg)},
          {"full_well_electrons", json_number(wear.full_well_electrons)},
          {"snowflakes", wear.snowflakes},
          {"bonnet_share", json_number(wear.bonnet_share)},
          {"jpeg_quality", wear.jpeg_quality}};
}

Json damage_json(const synth::DamageTruth& damage) {
  return {{"id", damage.id},
          {"kind", damage.kind},
          {"x_m", json_number(damage.x_m)},
          {"y_m", json_number(damage.y_m)},
          {"depth_m", json_number(damage.depth_m)},
          {"mean_depth_m", json_number(damage.mean_depth_m)},
          {"area_m2", json_number(damage.area_m2)},
          {"volume_m3", json_number(damage.volume_m3)}};
}

}  // namespace

std::string truth_json(const synth::Scene& scene, const synth::SyntheticPair& pair) {
  Json document = {{"version", version}, {"scene", scene.name}};
  document["plane"] = {
      {"a0", json_number(pair.plane.a0)}, {"a1", json_number(pair.plane.a1)}, {"a2", json_number(pair.plane.a2)}};
  document["roll_rad"] = json_number(pair.roll_rad);
  document["rig"] = rig_json(scene.rig);
  document["degradation"] = degradation_json(scene.degradation);
  document["damages"] = Json::array();
  for (const synth::DamageTruth& damage : pair.damages) document["damages"].push_back(damage_json(damage));
  return json_text(document);
}

}  // namespace roadstereo::cli
