#include "live/recent_health.hpp"

#include <algorithm>
#include <cmath>

#include "series_health.hpp"

namespace roadstereo::cli {

void RecentHealth::add(const Pair& pair) {
  last_.push_back(pair);
  if (last_.size() > pairs) last_.pop_front();
}

void RecentHealth::add(const PairHealth& health) {
  add(Pair{true, health.row_offset_px});
}

void RecentHealth::add_without_result() {
  add(Pair{false, PairHealth::unknown});
}

double RecentHealth::vibration_px() const {
  std::vector<double> offsets;
  for (const Pair& pair : last_) {
    if (std::isfinite(pair.row_offset_px)) offsets.push_back(pair.row_offset_px);
  }
  return cli::vibration_px(offsets);
}

double RecentHealth::lost_share() const {
  constexpr std::size_t min_pairs = 100;
  if (last_.size() < min_pairs) return PairHealth::unknown;
  const auto lost = std::count_if(last_.begin(), last_.end(), [](const Pair& pair) { return !pair.has_result; });
  return static_cast<double>(lost) / static_cast<double>(last_.size());
}

std::vector<HealthFinding> RecentHealth::findings() const {
  std::vector<HealthFinding> findings;
  const auto vibration = vibration_finding(vibration_px());
  const auto lost = lost_pairs_finding(lost_share(), "see the reason, and check cables and triggers");
  for (const auto& finding : {vibration, lost}) {
    if (finding) findings.push_back(*finding);
  }
  return findings;
}

}  // namespace roadstereo::cli
