#pragma once

#include "roadstereo/io/flight_frame.hpp"

namespace roadstereo::io {

// Fields of a frame record: each calls `visit(name, value)` for the fields of one struct, in the order of the journal.

template <class Visit>
void each_field(Measurement& measured, Visit& visit) {
  visit("value", measured.value);
  visit("std_error", measured.std_error);
}

template <class Visit>
void each_field(DisparityPlane& model, Visit& visit) {
  visit("a0", model.a0);
  visit("a1", model.a1);
  visit("a2", model.a2);
}

template <class Visit>
void each_field(TrackedRoad& road, Visit& visit) {
  visit("model", road.model);
  visit("inlier_share", road.inlier_share);
  visit("correlation", road.correlation);
  visit("samples_are_cells", road.samples_are_cells);
}

template <class Visit>
void each_field(Misalignment& misalignment, Visit& visit) {
  visit("rows_px", misalignment.rows_px);
  visit("turn_rad", misalignment.turn_rad);
  visit("row_scale", misalignment.row_scale);
  visit("cx_px", misalignment.cx_px);
  visit("cy_px", misalignment.cy_px);
}

template <class Visit>
void each_field(PipelineState& state, Visit& visit) {
  visit("width", state.width);
  visit("height", state.height);
  visit("road", state.road);
  visit("roll_rad", state.roll_rad);
  visit("misalignment", state.misalignment);
  visit("rows_known", state.rows_known);
  visit("frames_since_rows", state.frames_since_rows);
  visit("blur_px2", state.blur_px2);
  visit("frames_since_blur", state.frames_since_blur);
}

template <class Visit>
void each_field(SeverityProbabilities& probabilities, Visit& visit) {
  visit("minor", probabilities.minor);
  visit("low", probabilities.low);
  visit("medium", probabilities.medium);
  visit("high", probabilities.high);
}

template <class Visit>
void each_field(DamageEvidence& evidence, Visit& visit) {
  visit("contrast_sigmas", evidence.contrast_sigmas);
  visit("significance", evidence.significance);
  visit("steepness", evidence.steepness);
  visit("road_share", evidence.road_share);
  visit("border_share", evidence.border_share);
  visit("unseen_share", evidence.unseen_share);
  visit("surface_significance", evidence.surface_significance);
  visit("range_vote", evidence.range_vote);
  visit("specular_excess", evidence.specular_excess);
  visit("texture_share", evidence.texture_share);
  visit("pixel_significance", evidence.pixel_significance);
  visit("likely_wall_slope", evidence.likely_wall_slope);
  visit("extent", evidence.extent);
  visit("rut_significance", evidence.rut_significance);
  visit("clutter", evidence.clutter);
  visit("depth_significance", evidence.depth_significance);
}

template <class Visit>
void each_field(DamageMetrics& metrics, Visit& visit) {
  visit("area_m2", metrics.area_m2);
  visit("max_depth_m", metrics.max_depth_m);
  visit("mean_depth_m", metrics.mean_depth_m);
  visit("volume_m3", metrics.volume_m3);
  visit("length_m", metrics.length_m);
  visit("width_m", metrics.width_m);
  visit("angle_rad", metrics.angle_rad);
  visit("diameter_m", metrics.diameter_m);
  visit("wall_slope", metrics.wall_slope);
  visit("outline_m", metrics.outline_m);
  visit("centroid_m", metrics.centroid_m);
  visit("road_centroid_m", metrics.road_centroid_m);
  visit("distance_m", metrics.distance_m);
  visit("resolvable_depth_m", metrics.resolvable_depth_m);
  visit("distress", metrics.distress);
  visit("quantity", metrics.quantity);
  visit("unit", metrics.unit);
  visit("severity_probabilities", metrics.severity_probabilities);
  visit("severity", metrics.severity);
}

template <class Visit>
void each_field(Damage& damage, Visit& visit) {
  visit("id", damage.id);
  visit("kind", damage.kind);
  visit("pixels", damage.pixels);
  visit("measured_share", damage.measured_share);
  visit("centroid_px", damage.centroid_px);
  visit("box_px", damage.box_px);
  visit("deepest_px", damage.deepest_px);
  visit("max_depth_px", damage.max_depth_px);
  visit("mean_depth_px", damage.mean_depth_px);
  visit("confidence", damage.confidence);
  visit("evidence", damage.evidence);
  visit("cut_by_border", damage.cut_by_border);
  visit("ends_search", damage.ends_search);
  visit("metrics", damage.metrics);
}

template <class Visit>
void each_field(LensSpots& spots, Visit& visit) {
  visit("dirt", spots.dirt);
  visit("dead_pixels", spots.dead_pixels);
  visit("dead_share", spots.dead_share);
  visit("largest_u", spots.largest_u);
  visit("largest_v", spots.largest_v);
}

template <class Visit>
void each_field(PairHealth& health, Visit& visit) {
  visit("row_offset_px", health.row_offset_px);
  visit("row_correction_px", health.row_correction_px);
  visit("row_scale", health.row_scale);
  visit("row_turn_rad", health.row_turn_rad);
  visit("row_error_px", health.row_error_px);
  visit("row_scatter_px", health.row_scatter_px);
  visit("distortion_right", health.distortion_right);
  visit("distortion_both", health.distortion_both);
  visit("bowl_px", health.bowl_px);
  visit("noise_px", health.noise_px);
  visit("wave_px", health.wave_px);
  visit("gain", health.gain);
  visit("clipped_left", health.clipped_left);
  visit("clipped_right", health.clipped_right);
  visit("blur_left_px", health.blur_left_px);
  visit("blur_right_px", health.blur_right_px);
  visit("noise_share", health.noise_share);
  visit("stripe_share", health.stripe_share);
  visit("blocks_left", health.blocks_left);
  visit("blocks_right", health.blocks_right);
  visit("infinity_px", health.infinity_px);
  visit("left_spots", health.spots.left);
  visit("right_spots", health.spots.right);
  visit("threshold_sigma", health.threshold_sigma);
}

template <class Visit>
void each_field(StaticMaskRecord& mask, Visit& visit) {
  visit("judged", mask.judged);
  visit("frame", mask.frame);
  visit("share", mask.share);
  visit("applied", mask.applied);
}

template <class Visit>
void each_field(RigBiasFrame& frame, Visit& visit) {
  visit("width", frame.width);
  visit("height", frame.height);
  visit("region_px", frame.region_px);
  visit("weight", frame.weight);
  visit("matrix", frame.matrix);
  visit("vector", frame.vector);
  visit("planes", frame.planes);
}

template <class Visit>
void each_field(FlightPose& pose, Visit& visit) {
  visit("piece", pose.piece);
  visit("road_to_world", pose.road_to_world);
}

template <class Visit>
void each_field(FlightFrame& frame, Visit& visit) {
  visit("frame", frame.index);
  visit("name", frame.name);
  visit("time_s", frame.time_s);
  visit("status", frame.status);
  visit("reason", frame.reason);
  visit("road_status", frame.road_status);
  visit("roll_rad", frame.roll_rad);
  visit("roll_stderr_rad", frame.roll_stderr_rad);
  visit("roll_observable", frame.roll_observable);
  visit("alpha0", frame.alpha0);
  visit("alpha1", frame.alpha1);
  visit("road", frame.road);
  visit("height_m", frame.height_m);
  visit("pitch_rad", frame.pitch_rad);
  visit("height_stderr_m", frame.height_stderr_m);
  visit("pitch_stderr_rad", frame.pitch_stderr_rad);
  visit("sigma_d_px", frame.sigma_d_px);
  visit("valid_share", frame.valid_share);
  visit("noise_px", frame.noise_px);
  visit("matching_ms", frame.matching_ms);
  visit("damage_ms", frame.damage_ms);
  visit("pose", frame.pose);
  visit("footprint_m", frame.footprint_m);
  visit("health", frame.health);
  visit("rig_bias", frame.rig_bias);
  visit("damages", frame.damages);
  visit("candidates", frame.candidates);
  visit("warnings", frame.warnings);
  visit("white_level", frame.white_level);
  visit("pipeline_state", frame.pipeline_state);
  visit("static_mask", frame.static_mask);
}

}  // namespace roadstereo::io
