#include "flight_path.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

using synth::FlightPath;

/// A parameter of the flight.
struct Key {
  const char* key;
  double FlightPath::*member;
  const char* meaning;
};

constexpr std::array<Key, 14> keys{{
    {"roll", &FlightPath::roll_deg, "amplitude of the roll, degrees"},
    {"pitch", &FlightPath::pitch_deg, "amplitude of the pitch, degrees"},
    {"climb", &FlightPath::climb_m, "maximum climb above the start, metres"},
    {"roll_period", &FlightPath::roll_period, "period of the roll, frames"},
    {"pitch_period", &FlightPath::pitch_period, "period of the pitch, frames"},
    {"climb_period", &FlightPath::climb_period, "period of the climb, frames"},
    {"step", &FlightPath::step_m, "motion along the road per frame, metres"},
    {"loop", &FlightPath::loop_period, "frames of a full circle to the right, 0: straight ahead"},
    {"turn", &FlightPath::turn_frame, "frame at which a straight flight turns to fly back, 0: never"},
    {"jump_roll", &FlightPath::jump_roll_deg, "change of the roll at a jump, degrees"},
    {"jump_pitch", &FlightPath::jump_pitch_deg, "change of the pitch at a jump, degrees"},
    {"jump_climb", &FlightPath::jump_climb_m, "change of the height at a jump, metres"},
    {"jump_step", &FlightPath::jump_step_m, "change of the position along the road at a jump, metres"},
    {"shutter", &FlightPath::shutter_frames, "time from the first row to the last, frames, 0: global shutter"},
}};

template <class Number>
Number parse_number(const std::string& key, const std::string& text, const char* wanted) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || text.empty()) {
    fail("--flight: '", text, "' is not a value of ", key, "; it must be ", wanted);
  }
  return value;
}

void set_value(const std::string& key, const std::string& value, FlightPath& path) {
  if (key == "jump") {
    path.jumps.push_back(parse_number<int>(key, value, "the number of a frame"));
    return;
  }
  if (key == "period") {
    path.roll_period = path.pitch_period = path.climb_period = parse_number<double>(key, value, "a number");
    return;
  }
  for (const Key& entry : keys) {
    if (key != entry.key) continue;
    path.*entry.member = parse_number<double>(key, value, "a number");
    return;
  }
  std::string known = "jump, period";
  for (const Key& entry : keys) known += std::string(", ") + entry.key;
  fail("--flight has no key '", key, "'; the keys are ", known);
}

}  // namespace

synth::FlightPath parse_flight(const std::string& text) {
  FlightPath path;
  if (text == default_flight) return path;
  for (std::size_t first = 0; first <= text.size();) {
    const std::size_t last = std::min(text.find(',', first), text.size());
    const std::string part = text.substr(first, last - first);
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0) {
      fail("--flight must be ", default_flight, " or key=value,…, for example roll=6,step=0.1,jump=150, but is \"",
           part, "\"");
    }
    set_value(part.substr(0, equals), part.substr(equals + 1), path);
    first = last + 1;
  }
  path.validate();
  return path;
}

std::string flight_help() {
  const FlightPath usual;
  std::string text = "--flight is \"default\" or key=value,… with the keys:\n";
  for (const Key& entry : keys) {
    text += fmt::format("  {:<13} {} ({})\n", entry.key, entry.meaning, usual.*entry.member);
  }
  text += "  period        all three periods, frames\n";
  text += "  jump          frame at which the pose jumps; the next jump returns to the path. Repeatable\n";
  return text;
}

}  // namespace roadstereo::cli
