#include "flight/frame_messages.hpp"

#include <cmath>

#include "io/ros/mcap_chunk.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cli {

std::vector<std::uint8_t> encode_frame_messages(const std::optional<StereoCalibration>& calibration,
                                                const FlightJob& job) {
  io::RosFrame frame;
  frame.sequence = static_cast<std::uint32_t>(job.sequence);
  frame.time_s = std::isfinite(job.frame.time_s) ? job.frame.time_s : static_cast<double>(job.frame.index);
  frame.left = job.pair.left.view();
  frame.white_level = job.frame.white_level;
  frame.maps = {job.result.disparity, job.result.sigma, job.result.grey};
  frame.damages = job.damage.damages;
  frame.calibration = calibration ? &*calibration : nullptr;
  if (job.result.roll_found) frame.road = job.result.geometry.plane;
  frame.pose = job.pose;
  try {
    return io::mcap_chunk(io::flight_messages(frame));
  } catch (const SystemError&) {
    throw;
  } catch (const Error& error) {
    fail("--write mcap, frame ", job.frame.index, ": ", error.what());
  }
}

}  // namespace roadstereo::cli
