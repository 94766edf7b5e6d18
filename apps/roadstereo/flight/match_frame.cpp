#include "flight/match_frame.hpp"

#include "roadstereo/error.hpp"
#include "roadstereo/ground_plane.hpp"
#include "roadstereo/io/flight_frame.hpp"
#include "roadstereo/io/image_file.hpp"

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
  frame.name = io::valid_utf8(job.pair.name);
  frame.time_s = job.pair.time_s;
  frame.reason = io::valid_utf8(job.pair.error);
  if (!frame.reason.empty()) frame.status = io::FrameStatus::rejected;
  job.damage.damages.clear();
  job.damage.candidates.clear();
  job.files.clear();
  job.pose.reset();
  job.mcap_chunk.clear();
}

void add_static_mask(const AutoMask& mask, FlightJob& job) {
  const Image<std::uint8_t>& pixels = mask.mask();
  job.frame.warnings.push_back(static_mask_warning(mask.record()));
  job.files.push_back(
      {static_mask_file, io::encode_png(FrameView::grey8(pixels.row(0), pixels.width(), pixels.height()))});
}

}  // namespace

void match_frame(Pipeline& pipeline, const std::optional<StereoCalibration>& calibration, PairWatch& watch,
                 AutoMask& mask, FlightJob& job) {
  begin(job);
  bool found_mask = false;
  if (job.frame.status == io::FrameStatus::good) {
    try {
      found_mask = mask.apply(job.pair.index, job.pair.left.view(), job.pair.right.view(), pipeline);
      pipeline.process(job.pair.left.view(), job.pair.right.view(), job.result);
      record(job.result, calibration, job.frame);
      job.frame.health.spots = watch.add(job.result.grey, job.result.right);
    } catch (const SystemError&) {
      throw;
    } catch (const Error& error) {
      job.frame.status = io::FrameStatus::failed;
      job.frame.reason = io::valid_utf8(error.what());
    }
  }
  if (found_mask) add_static_mask(mask, job);
  job.frame.static_mask = mask.record();
  job.frame.white_level = pipeline.options().white_level;
  job.frame.pipeline_state = pipeline.carried();
}

void record_rejected(const std::optional<io::FlightFrame>& before, FlightJob& job) {
  begin(job);
  if (!before) return;
  job.frame.white_level = before->white_level;
  job.frame.pipeline_state = before->pipeline_state;
  job.frame.static_mask = before->static_mask;
}

}  // namespace roadstereo::cli
