#include "graph/fix_curve.hpp"

#include "roadstereo/error.hpp"

namespace roadstereo {

FixCurve::FixCurve(std::vector<PositionFix> fixes, double max_gap_s) : fixes_(std::move(fixes)), max_gap_s_(max_gap_s) {
  for (const PositionFix& fix : fixes_) fix.validate();
  for (std::size_t i = 1; i < fixes_.size(); ++i) {
    if (fixes_[i].time_s > fixes_[i - 1].time_s) continue;
    fail("fix ", i, " is at ", fixes_[i].time_s, " s, the one before it at ", fixes_[i - 1].time_s,
         " s; times must increase");
  }
  for (const PositionFix& fix : fixes_) positions_.emplace_back(fix.position_m.data());
  fill_altitudes();
  std::vector<double> times_s;
  for (const PositionFix& fix : fixes_) times_s.push_back(fix.time_s);
  tangents_ = parabola_tangents(times_s, positions_);
}

/// Those that are unknown are on a line through the known ones before and after, level beyond the first and the last.
void FixCurve::fill_altitudes() {
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    if (std::isnan(positions_[i].z())) continue;
    const double from_s = fixes_[last.value_or(0)].time_s, to_s = fixes_[i].time_s;
    for (std::size_t k = last ? *last + 1 : 0; k < i; ++k) {
      const double share = last ? (fixes_[k].time_s - from_s) / (to_s - from_s) : 1;
      positions_[k].z() = std::lerp(last ? positions_[*last].z() : positions_[i].z(), positions_[i].z(), share);
    }
    last = i;
  }
  for (std::size_t k = last ? *last + 1 : 0; k < positions_.size(); ++k) {
    positions_[k].z() = last ? positions_[*last].z() : 0;
  }
}

std::optional<std::size_t> FixCurve::segment(double time_s) const {
  if (fixes_.size() < 2 || !(time_s >= fixes_.front().time_s && time_s <= fixes_.back().time_s)) return std::nullopt;
  const auto after = std::upper_bound(fixes_.begin() + 1, fixes_.end() - 1, time_s,
                                      [](double time, const PositionFix& fix) { return time < fix.time_s; });
  const auto index = static_cast<std::size_t>(after - fixes_.begin()) - 1;
  if (fixes_[index + 1].time_s - fixes_[index].time_s > max_gap_s_) return std::nullopt;
  return index;
}

}  // namespace roadstereo
