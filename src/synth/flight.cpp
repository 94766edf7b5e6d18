#include <algorithm>
#include <cmath>
#include <numbers>

#include "roadstereo/error.hpp"
#include "roadstereo/synth.hpp"

namespace roadstereo::synth {
namespace {

void require(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  fail("flight: ", name, " is ", value, "; it must be between ", low, " and ", high);
}

/// Height above the start, as a share of the highest: 0 at the start and after every period.
double rise(double frame, double period) {
  return 0.5 * (1 - std::cos(2 * std::numbers::pi * frame / period));
}

double sway(double frame, double period) {
  return std::sin(2 * std::numbers::pi * frame / period);
}

}  // namespace

void FlightPath::validate() const {
  constexpr double largest_deg = 45, shortest_period = 2, longest_period = 1e6, highest_m = 100;
  require("roll_deg", roll_deg, 0, largest_deg);
  require("roll_period", roll_period, shortest_period, longest_period);
  require("pitch_deg", pitch_deg, 0, largest_deg);
  require("pitch_period", pitch_period, shortest_period, longest_period);
  require("climb_m", climb_m, 0, highest_m);
  require("climb_period", climb_period, shortest_period, longest_period);
  require("step_m", step_m, -10, 10);
  require("jump_roll_deg", jump_roll_deg, -largest_deg, largest_deg);
  require("jump_pitch_deg", jump_pitch_deg, -largest_deg, largest_deg);
  require("jump_climb_m", jump_climb_m, -highest_m, highest_m);
  require("jump_step_m", jump_step_m, -1000, 1000);
  for (std::size_t i = 0; i < jumps.size(); ++i) {
    if (jumps[i] < 1) fail("flight: a jump is at frame ", jumps[i], "; it must be at frame 1 or later");
    if (std::count(jumps.begin(), jumps.end(), jumps[i]) > 1) fail("flight: frame ", jumps[i], " jumps twice");
  }
}

Scene flight_frame(const Scene& scene, const FlightPath& path, int frame) {
  path.validate();
  if (frame < 0) fail("frame is ", frame, "; it must not be negative");
  const double t = frame;
  const auto jumps = std::count_if(path.jumps.begin(), path.jumps.end(), [frame](int jump) { return jump <= frame; });
  const double jumped = jumps % 2 != 0 ? 1 : 0;
  Scene next = scene;
  Rig& rig = next.rig;
  rig.y_m += t * path.step_m + static_cast<double>(jumps) * path.jump_step_m;
  rig.camera_height_m += path.climb_m * rise(t, path.climb_period) + jumped * path.jump_climb_m;
  rig.roll_deg += path.roll_deg * sway(t, path.roll_period) + jumped * path.jump_roll_deg;
  rig.pitch_deg += path.pitch_deg * sway(t, path.pitch_period) + jumped * path.jump_pitch_deg;
  rig.pitch_deg = std::clamp(rig.pitch_deg, 0.0, 90.0);
  next.degradation.noise_seed += static_cast<std::uint32_t>(frame);
  if (frame > 0) rig.validate();
  return next;
}

}  // namespace roadstereo::synth
