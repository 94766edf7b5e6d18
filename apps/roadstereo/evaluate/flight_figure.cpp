#include "evaluate/flight_figure.hpp"

#include <algorithm>
#include <string>

#include "roadstereo/io/plot.hpp"

namespace roadstereo::cli {
namespace {

template <class Value>
io::Curve over_frames(const std::string& name, const std::vector<FlightTrial>& frames, const Value& value) {
  io::Curve curve{name, {}, {}};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    curve.x.push_back(static_cast<double>(i));
    curve.y.push_back(value(frames[i]));
  }
  return curve;
}

/// The frames whose road model was estimated anew, beyond the first.
std::vector<double> jumps(const std::vector<FlightTrial>& frames) {
  std::vector<double> at;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (frames[i].reestimated) at.push_back(static_cast<double>(i));
  }
  return at;
}

io::Panel error_panel(const std::string& title, const std::string& label, const std::vector<FlightTrial>& frames,
                      double RoadError::*error) {
  io::Panel panel{title, "frame", label, {}, false, true};
  panel.curves = {
      over_frames("carried over, before matching", frames,
                  [&](const FlightTrial& f) { return f.tracked.before.*error; }),
      over_frames("afresh, before matching", frames, [&](const FlightTrial& f) { return f.fresh.before.*error; }),
      over_frames("carried over, after it", frames, [&](const FlightTrial& f) { return f.tracked.after.*error; }),
      over_frames("afresh, after it", frames, [&](const FlightTrial& f) { return f.fresh.after.*error; })};
  panel.curves[1].dashed = panel.curves[3].dashed = true;
  panel.vertical_lines = jumps(frames);
  return panel;
}

}  // namespace

Frame draw_flight(const std::vector<FlightTrial>& frames) {
  io::Panel time{"Time of a frame", "frame", "ms, least of all passes", {}};
  time.curves = {over_frames(
      "", frames, [](const FlightTrial& f) { return *std::min_element(f.times_ms.begin(), f.times_ms.end()); })};
  time.y_lowest = 0;
  time.vertical_lines = jumps(frames);
  std::vector<io::Panel> panels;
  // Straight down there is no roll to plot.
  const bool observable =
      std::any_of(frames.begin(), frames.end(), [](const FlightTrial& f) { return f.fresh.after.roll_rad > 0; });
  if (observable) panels.push_back(error_panel("Roll", "error of psi, rad", frames, &RoadError::roll_rad));
  panels.push_back(error_panel("Road model", "largest error of the plane, px", frames, &RoadError::plane_px));
  panels.push_back(time);
  return io::draw_plot(panels);
}

}  // namespace roadstereo::cli
