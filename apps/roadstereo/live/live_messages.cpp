#include "live/live_messages.hpp"

#include "io/ros/flight_messages.hpp"

namespace roadstereo::cli {

LiveMessages::LiveMessages(std::uint32_t domain, const std::optional<StereoCalibration>& calibration)
    : calibration_(calibration), publisher_(domain, io::flight_topics(calibration.has_value(), true)) {
  if (calibration) path_.emplace(*calibration);
}

std::optional<io::RosPose> LiveMessages::next_pose(const FrameResult& result) {
  if (!path_ || !path_->is_due()) return std::nullopt;
  return path_->follow({result.grey, result.disparity, result.sigma,
                        result.roll_found ? std::optional(result.geometry.plane) : std::nullopt, Clock::now()});
}

void LiveMessages::publish(const FrameView& left, double white_level, double clock_s, const FrameResult& result,
                           const DamageMap& damage) {
  io::RosFrame frame;
  frame.sequence = sequence_++;
  if (!publisher_.has_subscribers()) return;
  frame.pose = next_pose(result);
  frame.time_s = clock_s;
  frame.left = left;
  frame.white_level = white_level;
  frame.maps = {result.disparity, result.sigma, result.grey};
  frame.damages = damage.damages;
  frame.calibration = calibration_ ? &*calibration_ : nullptr;
  if (result.roll_found) frame.road = result.geometry.plane;
  publisher_.publish(io::flight_messages(frame));
}

}  // namespace roadstereo::cli
