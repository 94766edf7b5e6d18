#include "flight_path.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "roadstereo/error.hpp"

namespace roadstereo::cli {
namespace {

using synth::FlightPath;

/// A figure of the flight by name.
struct Figure {
  const char* key;
  double FlightPath::*member;
  const char* meaning;
};

constexpr std::array<Figure, 11> figures{{
    {"roll", &FlightPath::roll_deg, "rolling, amplitude in degrees"},
    {"pitch", &FlightPath::pitch_deg, "pitching, amplitude in degrees"},
    {"climb", &FlightPath::climb_m, "climbing, metres above the start at most"},
    {"roll_period", &FlightPath::roll_period, "of rolling, frames"},
    {"pitch_period", &FlightPath::pitch_period, "of pitching, frames"},
    {"climb_period", &FlightPath::climb_period, "of climbing, frames"},
    {"step", &FlightPath::step_m, "metres along the road per frame"},
    {"jump_roll", &FlightPath::jump_roll_deg, "what a jump adds to the roll, degrees"},
    {"jump_pitch", &FlightPath::jump_pitch_deg, "... to the pitch, degrees"},
    {"jump_climb", &FlightPath::jump_climb_m, "... to the height, metres"},
    {"jump_step", &FlightPath::jump_step_m, "... to the way along the road, metres"},
}};

template <class Number>
Number parse_number(const std::string& key, const std::string& text, const char* wanted) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || text.empty()) {
    fail("--flight: '", text, "' is no value for ", key, "; it takes ", wanted);
  }
  return value;
}

void set_figure(const std::string& key, const std::string& value, FlightPath& path) {
  if (key == "jump") {
    path.jumps.push_back(parse_number<int>(key, value, "the number of a frame"));
    return;
  }
  if (key == "period") {
    path.roll_period = path.pitch_period = path.climb_period = parse_number<double>(key, value, "a number");
    return;
  }
  for (const Figure& figure : figures) {
    if (key != figure.key) continue;
    path.*figure.member = parse_number<double>(key, value, "a number");
    return;
  }
  std::string known = "jump, period";
  for (const Figure& figure : figures) known += std::string(", ") + figure.key;
  fail("--flight knows no '", key, "'; it knows ", known);
}

}  // namespace

synth::FlightPath parse_flight(const std::string& text) {
  FlightPath path;
  if (text == usual_flight) return path;
  for (std::size_t first = 0; first <= text.size();) {
    const std::size_t last = std::min(text.find(',', first), text.size());
    const std::string part = text.substr(first, last - first);
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0) {
      fail("--flight takes ", usual_flight, " or key=value,…, for example roll=6,step=0.1,jump=150, but got \"", part,
           "\"");
    }
    set_figure(part.substr(0, equals), part.substr(equals + 1), path);
    first = last + 1;
  }
  path.validate();
  return path;
}

std::string flight_help() {
  const FlightPath usual;
  std::string text = "A flight is \"default\" or key=value,… of:\n";
  for (const Figure& figure : figures) {
    text += fmt::format("  {:<13} {} ({})\n", figure.key, figure.meaning, usual.*figure.member);
  }
  text += "  period        of all three, frames\n";
  text += "  jump          frame from which on the pose is another one; the next one leads back. May be repeated\n";
  return text;
}

}  // namespace roadstereo::cli
