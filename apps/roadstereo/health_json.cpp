#include "health_json.hpp"

#include "json_text.hpp"

namespace roadstereo::cli {

using Json = nlohmann::ordered_json;

Json findings_json(const std::vector<HealthFinding>& findings) {
  Json list = Json::array();
  for (const HealthFinding& finding : findings) {
    list.push_back({{"id", finding.id},
                    {"value", json_number(finding.value)},
                    {"limit", json_number(finding.limit)},
                    {"unit", finding.unit},
                    {"text", finding.text},
                    {"spoils_depth", finding.spoils_depth}});
  }
  return list;
}

namespace {

Json spots_json(const LensSpots& spots) {
  return {{"dirt", json_number(spots.dirt)},
          {"dead_pixels", json_number(spots.dead_pixels)},
          {"largest_u", json_number(spots.largest_u)},
          {"largest_v", json_number(spots.largest_v)}};
}

}  // namespace

Json health_json(const PairHealth& health) {
  return {{"depth_is_trusted", health.depth_is_trusted()},
          {"findings", findings_json(health.findings())},
          {"row_offset_px", json_number(health.row_offset_px)},
          {"row_scale", json_number(health.row_scale)},
          {"row_turn_rad", json_number(health.row_turn_rad)},
          {"row_error_px", json_number(health.row_error_px)},
          {"row_scatter_px", json_number(health.row_scatter_px)},
          {"distortion_right", json_number(health.distortion_right)},
          {"distortion_both", json_number(health.distortion_both)},
          {"bowl_px", json_number(health.bowl_px)},
          {"wave_px", json_number(health.wave_px)},
          {"gain", json_number(health.gain)},
          {"clipped_left", json_number(health.clipped_left)},
          {"clipped_right", json_number(health.clipped_right)},
          {"blur_left_px", json_number(health.blur_left_px)},
          {"blur_right_px", json_number(health.blur_right_px)},
          {"noise_share", json_number(health.noise_share)},
          {"stripe_share", json_number(health.stripe_share)},
          {"blocks_left", json_number(health.blocks_left)},
          {"blocks_right", json_number(health.blocks_right)},
          {"infinity_px", json_number(health.infinity_px)},
          {"left_spots", spots_json(health.spots.left)},
          {"right_spots", spots_json(health.spots.right)}};
}

}  // namespace roadstereo::cli
