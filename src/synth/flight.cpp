#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/degrees.hpp"
#include "roadstereo/error.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::synth {
namespace {

void require_in_range(const char* name, double value, double lower, double upper) {
  if (value >= lower && value <= upper) return;
  fail("flight: ", name, " is ", value, "; it must be between ", lower, " and ", upper);
}

/// Raised cosine, 0 … 1: 0 at frame 0 and after every period.
double raised_cosine(double frame, double period) {
  return 0.5 * (1 - std::cos(2 * std::numbers::pi * frame / period));
}

double sine_wave(double frame, double period) {
  return std::sin(2 * std::numbers::pi * frame / period);
}

/// Moves the rig on a circle to the right whose circumference is the length of all steps, always looking ahead.
void circle(const FlightPath& path, double frame, Rig& rig) {
  const double turn = 2 * std::numbers::pi * frame / path.loop_period;
  const double radius_m = path.loop_period * path.step_m / (2 * std::numbers::pi);
  rig.x_m += radius_m * (1 - std::cos(turn));
  rig.y_m += radius_m * std::sin(turn);
  rig.yaw_deg = std::remainder(rig.yaw_deg - to_degrees(turn), 360.0);
}

/// Moves the rig along the road, and after `turn_frame` frames back: within 30 frames round half a circle to the right.
void straight(const FlightPath& path, double frame, Rig& rig) {
  constexpr double radius_m = 0.15, turn_frames = 30;
  if (path.turn_frame == 0 || frame <= path.turn_frame) {
    rig.y_m += frame * path.step_m;
    return;
  }
  const double turn = std::numbers::pi * std::min((frame - path.turn_frame) / turn_frames, 1.0);
  const double back = std::max(frame - path.turn_frame - turn_frames, 0.0);
  rig.x_m += radius_m * (1 - std::cos(turn));
  rig.y_m += (path.turn_frame - back) * path.step_m + radius_m * std::sin(turn);
  rig.yaw_deg = std::remainder(rig.yaw_deg - to_degrees(turn), 360.0);
}

/// Pose of the rig at a time, in frames. Jumps are between frames.
Rig rig_at(const Scene& scene, const FlightPath& path, double time, std::ptrdiff_t jumps) {
  const double is_offset = jumps % 2 != 0 ? 1 : 0;
  Rig rig = scene.rig;
  rig.y_m += static_cast<double>(jumps) * path.jump_step_m;
  if (path.loop_period == 0) straight(path, time, rig);
  if (path.loop_period != 0) circle(path, time, rig);
  rig.camera_height_m += path.climb_m * raised_cosine(time, path.climb_period) + is_offset * path.jump_climb_m;
  rig.roll_deg += path.roll_deg * sine_wave(time, path.roll_period) + is_offset * path.jump_roll_deg;
  rig.pitch_deg += path.pitch_deg * sine_wave(time, path.pitch_period) + is_offset * path.jump_pitch_deg;
  rig.pitch_deg = std::clamp(rig.pitch_deg, 0.0, 90.0);
  return rig;
}

ShutterMotion motion_between(const Rig& first, const Rig& last) {
  return {last.x_m - first.x_m,
          last.y_m - first.y_m,
          last.camera_height_m - first.camera_height_m,
          last.pitch_deg - first.pitch_deg,
          last.roll_deg - first.roll_deg,
          std::remainder(last.yaw_deg - first.yaw_deg, 360.0)};
}

}  // namespace

void FlightPath::validate() const {
  constexpr double max_deg = 45, min_period = 2, max_period = 1e6, max_climb_m = 100;
  require_in_range("roll_deg", roll_deg, 0, max_deg);
  require_in_range("roll_period", roll_period, min_period, max_period);
  require_in_range("pitch_deg", pitch_deg, 0, max_deg);
  require_in_range("pitch_period", pitch_period, min_period, max_period);
  require_in_range("climb_m", climb_m, 0, max_climb_m);
  require_in_range("climb_period", climb_period, min_period, max_period);
  require_in_range("step_m", step_m, -10, 10);
  if (loop_period != 0) require_in_range("loop_period", loop_period, min_period, max_period);
  if (turn_frame != 0) require_in_range("turn_frame", turn_frame, 1, max_period);
  if (turn_frame != 0 && loop_period != 0)
    fail("flight: turn_frame is for straight flights, but loop_period is ", loop_period);
  require_in_range("jump_roll_deg", jump_roll_deg, -max_deg, max_deg);
  require_in_range("jump_pitch_deg", jump_pitch_deg, -max_deg, max_deg);
  require_in_range("jump_climb_m", jump_climb_m, -max_climb_m, max_climb_m);
  require_in_range("jump_step_m", jump_step_m, -1000, 1000);
  require_in_range("shutter_frames", shutter_frames, 0, 1);
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    if (jumps[i] < 1) fail("flight: a jump is at frame ", jumps[i], "; it must be at frame 1 or later");
    if (std::count(jumps.begin(), jumps.end(), jumps[i]) > 1)
      fail("flight: frame ", jumps[i], " jumps twice; each frame may be listed once");
  }
}

Scene flight_frame(const Scene& scene, const FlightPath& path, int frame) {
  path.validate();
  if (frame < 0) fail("frame is ", frame, "; it must not be negative");
  const double t = frame, half = path.shutter_frames / 2;
  const auto jumps = std::count_if(path.jumps.begin(), path.jumps.end(), [frame](int jump) { return jump <= frame; });
  Scene next = scene;
  next.rig = rig_at(scene, path, t, jumps);
  if (half > 0)
    next.shutter = motion_between(rig_at(scene, path, t - half, jumps), rig_at(scene, path, t + half, jumps));
  next.degradation.noise_seed += static_cast<std::uint32_t>(frame);
  if (frame > 0) next.rig.validate();
  return next;
}

}  // namespace roadstereo::synth
