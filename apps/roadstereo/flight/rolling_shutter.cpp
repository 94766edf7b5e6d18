#include "flight/rolling_shutter.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "flight/link_mean.hpp"

namespace roadstereo::cli {

std::optional<HealthFinding> rolling_shutter(const std::vector<FrameLink>& links,
                                             const std::map<int, double>& times_s) {
  constexpr double standard_errors = 5;
  constexpr double least_frames = 0.05;  // pictures of a global shutter seem to roll by up to a third of it
  const bool timed =
      std::all_of(times_s.begin(), times_s.end(), [](const auto& frame) { return std::isfinite(frame.second); });
  std::vector<LinkValue> readouts;
  double frames = 0, time = 0;
  for (const FrameLink& link : links) {
    const double duration = timed ? 1000 * (times_s.at(link.to) - times_s.at(link.from)) : link.to - link.from;
    if (!(link.shutter_sd > 0 && duration > 0)) continue;
    readouts.push_back({link.from, duration * link.shutter, duration * link.shutter_sd});
    frames += link.to - link.from;
    time += duration;
  }
  const std::optional<LinkMean> readout = mean_of_links(readouts);
  if (!readout) return std::nullopt;
  const double period = time / frames, value = std::abs(readout->value);
  const double limit = std::max(standard_errors * readout->std_error, least_frames * period);
  if (!(value > limit && value < period + limit)) return std::nullopt;
  const char* const unit = timed ? "ms" : "frames";
  return HealthFinding{
      "rolling-shutter",
      value,
      limit,
      unit,
      fmt::format("rolling shutter: the last row is exposed {:.2f} ± {:.2f} {} {} the first (limit {:.2f} {}), so "
                  "that motion shears pictures and bends the trajectory; use global shutters, or move slower",
                  value, readout->std_error, unit, readout->value > 0 ? "after" : "before", limit, unit),
      false};
}

}  // namespace roadstereo::cli
