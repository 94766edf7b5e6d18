#include "flight/finish_frame.hpp"

#include "find_damage_or_warn.hpp"
#include "flight/frame_files.hpp"
#include "flight/frame_messages.hpp"
#include "stopwatch.hpp"

namespace roadstereo::cli {

namespace {

void record_damage(const std::optional<StereoCalibration>& calibration, const DamageOptions& options, FlightJob& job) {
  constexpr int threads = 1;  // the others match the next frame
  if (find_damage_or_warn(job.result, calibration, options, threads, job.damage, job.frame.health,
                          job.frame.warnings)) {
    job.frame.noise_px = job.damage.noise_px;
  }
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
