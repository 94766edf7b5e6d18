#include "flight/match_frame.hpp"

#include "roadstereo/error.hpp"
#include "roadstereo/ground_plane.hpp"

namespace roadstereo::cli {

namespace {

void record(const FrameResult& result, const std::optional<StereoCalibration>& calibration, io::FlightFrame& frame) {
  frame.road_status = result.road.status;
  frame.valid_share = result.valid_share;
  frame.matching_ms = result.ms.total;
  frame.warnings = result.warnings;
  if (!result.roll_found) return;
  const RollEstimate& geometry = result.geometry;
  frame.roll_rad = geometry.roll_rad;
  frame.roll_stderr_rad = geometry.roll_stderr_rad;
  frame.roll_observable = geometry.roll_observable;
  frame.alpha0 = geometry.alpha0;
  frame.alpha1 = geometry.alpha1;
  frame.road = geometry.plane;
  frame.sigma_d_px = result.spread.sigma_road_px;
  if (!calibration) return;
  const GroundPlane plane = ground_plane(geometry.plane, *calibration);
  frame.height_m = plane.height_m;
  frame.pitch_rad = plane.pitch_rad;
  frame.footprint_m = road_footprint(geometry.plane, *calibration, result.disparity.width(), result.disparity.height());
}

/// Resets the job and fills the fields known before matching.
void begin(FlightJob& job) {
  io::FlightFrame& frame = job.frame;
  frame = {};
  frame.index = job.pair.index;
  frame.name = job.pair.name;
  frame.time_s = job.pair.time_s;
  frame.reason = job.pair.error;
  if (!frame.reason.empty()) frame.status = io::FrameStatus::rejected;
  job.damage.damages.clear();
  job.damage.candidates.clear();
  job.files.clear();
  job.pose.reset();
  job.mcap_chunk.clear();
}

}  // namespace

void match_frame(Pipeline& pipeline, const std::optional<StereoCalibration>& calibration, PairWatch& watch,
                 FlightJob& job) {
  begin(job);
  if (job.frame.status == io::FrameStatus::good) {
    try {
      pipeline.process(job.pair.left.view(), job.pair.right.view(), job.result);
      record(job.result, calibration, job.frame);
      job.frame.health.spots = watch.add(job.result.grey, job.result.right);
    } catch (const Error& error) {
      job.frame.status = io::FrameStatus::failed;
      job.frame.reason = error.what();
    }
  }
  job.frame.white_level = pipeline.options().white_level;
  job.frame.pipeline_state = pipeline.carried();
}

void record_rejected(const std::optional<io::FlightFrame>& before, FlightJob& job) {
  begin(job);
  if (!before) return;
  job.frame.white_level = before->white_level;
  job.frame.pipeline_state = before->pipeline_state;
}

}  // namespace roadstereo::cli
