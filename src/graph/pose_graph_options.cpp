#include <algorithm>
#include <cmath>

#include "core/require_range.hpp"
#include "roadstereo/pose_graph.hpp"

namespace roadstereo {

void PositionFix::validate() const {
  const auto finite = [](const char* name, double value) {
    if (!std::isfinite(value)) fail("a fix has the ", name, " ", value, "; it must be a finite number");
  };
  finite("time_s", time_s);
  finite("position_m[0]", position_m[0]);
  finite("position_m[1]", position_m[1]);
  require_range("fix", "horizontal_sd_m", horizontal_sd_m, Above{0.0}, unlimited);
  require_range("fix", "vertical_sd_m", vertical_sd_m, Above{0.0}, unlimited);
}

void PoseGraphOptions::validate() const {
  constexpr double least_s = 0.001, minutes_s = 600, hour_s = 3600;
  require_range("pose_graph", "max_time_offset_s", max_time_offset_s, 0.0, minutes_s);
  require_range("pose_graph", "time_offset_sd_s", time_offset_sd_s, least_s, minutes_s);
  require_range("pose_graph", "lever_arm_sd_m", lever_arm_sd_m, least_s, 100.0);
  require_range("pose_graph", "fix_correlation_s", fix_correlation_s, 0.0, hour_s);
  require_range("pose_graph", "max_fix_gap_s", max_fix_gap_s, least_s, hour_s);
}

std::size_t PoseGraphResult::loops_used() const {
  return static_cast<std::size_t>(
      std::count_if(loops.begin(), loops.end(), [](const LoopLink& loop) { return loop.used; }));
}

PoseGraphResult::Misclosure PoseGraphResult::misclosure() const {
  Misclosure sums;
  for (const LoopLink& loop : loops) {
    if (!loop.used) continue;
    sums.before_m += loop.before_m * loop.before_m;
    sums.after_m += loop.after_m * loop.after_m;
    sums.before_px += std::pow(loop.before_m / loop.pixel_m, 2);
    sums.after_px += std::pow(loop.after_m / loop.pixel_m, 2);
  }
  const double count = std::max(1.0, static_cast<double>(loops_used()));
  for (double* sum : {&sums.before_m, &sums.after_m, &sums.before_px, &sums.after_px}) *sum = std::sqrt(*sum / count);
  return sums;
}

}  // namespace roadstereo
