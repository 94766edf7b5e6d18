#include "series_health.hpp"

#include <fmt/core.h>

#include <cmath>
#include <cstddef>
#include <utility>

#include "core/order_statistics.hpp"
#include "finite_values.hpp"

namespace roadstereo::cli {

double vibration_px(const std::vector<double>& row_offsets_px) {
  constexpr std::size_t min_steps = 10;
  std::vector<double> steps;
  for (std::size_t i = 1; i < row_offsets_px.size(); ++i) {
    steps.push_back(std::abs(row_offsets_px[i] - row_offsets_px[i - 1]));
  }
  // The difference of two offsets has twice the variance of one.
  return steps.size() < min_steps ? PairHealth::unknown : gaussian_mad * median(std::move(steps)) / std::sqrt(2.0);
}

std::optional<HealthFinding> vibration_finding(double vibration_px) {
  constexpr double max_vibration_px = 0.5;
  if (!(vibration_px > max_vibration_px)) return std::nullopt;
  return HealthFinding{
      "vibration",
      vibration_px,
      max_vibration_px,
      "px",
      fmt::format("the offset of the rows changes by {:.2f} px from frame to frame (limit {} px): a camera vibrates; "
                  "damp its mount",
                  vibration_px, max_vibration_px),
      false};
}

std::optional<HealthFinding> lost_pairs_finding(double share, const std::string& advice) {
  constexpr double max_lost = 0.01;
  if (!(share > max_lost)) return std::nullopt;
  return HealthFinding{"lost-pairs",
                       share,
                       max_lost,
                       "",
                       fmt::format("{:.1f} % of the pairs are missing or have no result (limit {} %); {}", 100 * share,
                                   100 * max_lost, advice),
                       false};
}

}  // namespace roadstereo::cli
