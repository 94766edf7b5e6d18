#include "flight/finish_frame.hpp"

#include "flight/frame_files.hpp"
#include "roadstereo/error.hpp"
#include "stopwatch.hpp"

namespace roadstereo::cli {

namespace {

/// A frame that shows no road still has a disparity map: damage that cannot be looked for is a warning.
void look_for_damage(const std::optional<StereoCalibration>& calibration, const PipelineOptions& options,
                     FlightJob& job) {
  constexpr int threads = 1;  // the others match the next frame
  try {
    find_damage(job.result, calibration, options.damage, threads, job.damage);
    job.frame.noise_px = job.damage.noise_px;
  } catch (const Error& error) {
    job.damage =
        make_empty_damage_map(job.result.disparity.width(), job.result.disparity.height(), "no road was found");
    job.frame.warnings.push_back(std::string("damage was not looked for: ") + error.what());
  }
  job.frame.damages = job.damage.damages;
}

}  // namespace

void finish_frame(const std::optional<StereoCalibration>& calibration, const PipelineOptions& options,
                  const std::vector<FrameFile>& write, FlightJob& job) {
  if (job.frame.status != io::FrameStatus::good) return;
  job.frame.damage_ms = time_ms([&] { look_for_damage(calibration, options, job); });
  for (const FrameFile file : write) job.files.push_back(encode_frame_file(file, calibration, options, job));
}

}  // namespace roadstereo::cli
