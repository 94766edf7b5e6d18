#include "flight/finish_frame.hpp"

#include <algorithm>
#include <cmath>

#include "find_damage_or_warn.hpp"
#include "flight/frame_files.hpp"
#include "flight/frame_messages.hpp"
#include "roadstereo/ground_plane.hpp"
#include "stopwatch.hpp"

namespace roadstereo::cli {

namespace {

/// The road's deviation from its plane is what its noise does not explain. It is the difference of two variances that
/// are estimated themselves, from some hundred independent samples: not known to be less than a tenth.
void record_plane_error(const std::optional<StereoCalibration>& calibration, const Image<float>& disparity,
                        io::FlightFrame& frame) {
  if (!calibration || !std::isfinite(frame.height_m)) return;
  constexpr double least_share = 0.1;
  const double noise_px = std::isfinite(frame.noise_px) ? frame.noise_px : 0, all_px = frame.sigma_d_px;
  const double deviation_px = std::sqrt(std::max(all_px * all_px - noise_px * noise_px, least_share * all_px * all_px));
  const GroundPlaneError error =
      ground_plane_error(frame.road, *calibration, disparity.width(), disparity.height(), deviation_px);
  frame.height_stderr_m = error.height_m;
  frame.pitch_stderr_rad = error.pitch_rad;
}

void record_damage(const std::optional<StereoCalibration>& calibration, const DamageOptions& options, FlightJob& job) {
  constexpr int threads = 1;  // the others match the next frame
  if (find_damage_or_warn(job.result, calibration, options, threads, job.damage, job.frame.health,
                          job.frame.warnings)) {
    job.frame.noise_px = job.damage.noise_px;
  }
  job.frame.rig_bias = measure_rig_bias(job.result, job.damage);
  record_plane_error(calibration, job.result.disparity, job.frame);
  job.frame.damages = job.damage.damages;
  job.frame.candidates = job.damage.candidates;
}

}  // namespace

void finish_frame(const std::optional<StereoCalibration>& calibration, const FlightPlan& plan, FlightJob& job) {
  if (job.frame.status != io::FrameStatus::good) return;
  job.frame.damage_ms = time_ms([&] { record_damage(calibration, plan.options.damage, job); });
  for (const FrameFile file : plan.write) job.files.push_back(encode_frame_file(file, calibration, job));
  if (plan.mcap) job.mcap_chunk = encode_frame_messages(calibration, job);
}

}  // namespace roadstereo::cli
