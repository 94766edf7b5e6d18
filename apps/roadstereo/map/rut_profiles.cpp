#include "map/rut_profiles.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "core/order_statistics.hpp"

namespace roadstereo::cli {
namespace {

bool has_distress_rut(const RoadDamageRecord& record) {
  const auto& metrics = record.best.damage.metrics;
  return metrics && metrics->distress == Distress::rut;
}

}  // namespace

bool crosses_damage(const TransverseProfile& profile, std::span<const RoadDamageRecord> damages,
                    const LaneOptions& options) {
  const double cosine = std::cos(profile.heading_rad), sine = std::sin(profile.heading_rad);
  const auto is_in_strip = [&](const std::array<std::int32_t, 2>& cell) {
    const double x = (cell[0] + 0.5) * footprint_m - profile.at_m[0];
    const double y = (cell[1] + 0.5) * footprint_m - profile.at_m[1];
    return std::abs(x * cosine + y * sine) <= options.average_m / 2 &&
           std::abs(y * cosine - x * sine) <= options.lane_width_m / 2;
  };
  return std::any_of(damages.begin(), damages.end(), [&](const RoadDamageRecord& record) {
    const MapCells& cells = record.best.footprint;
    return !has_distress_rut(record) && std::any_of(cells.begin(), cells.end(), is_in_strip);
  });
}

std::string rut_text(std::span<const LaneProfiles> lanes, std::span<const RoadDamageRecord> damages) {
  constexpr std::size_t min_profiles = 5;
  constexpr double mm = 1000;  // in a metre
  std::vector<double> ruts, floors;
  std::size_t resolvable = 0, in_damage = 0;
  for (const LaneProfiles& lane : lanes) {
    for (const TransverseProfile& profile : lane.transverse) {
      if (crosses_damage(profile, damages)) {
        ++in_damage;
        continue;
      }
      ruts.push_back(profile.rut_depth_m.value);
      floors.push_back(profile.rut_noise_floor_m);
      resolvable += profile.rut_resolvable ? 1 : 0;
    }
  }
  if (ruts.empty() && in_damage == 0) return "  ruts      the mapped road is too narrow\n";
  const std::string left_out = in_damage == 0 ? "" : fmt::format("; {} more cross other damage", in_damage);
  if (ruts.empty()) return fmt::format("  ruts      unknown: all {} profiles cross other damage\n", in_damage);
  const bool few = ruts.size() < min_profiles;
  const double depth = few ? *std::max_element(ruts.begin(), ruts.end()) : upper_median(ruts);
  return fmt::format("  ruts      {} profile{}, {} {:.1f} mm; noise alone makes {:.1f} mm; resolvable in {}{}\n",
                     ruts.size(), ruts.size() == 1 ? "" : "s", few ? "largest" : "median", mm * depth,
                     mm * upper_median(floors), resolvable, left_out);
}

}  // namespace roadstereo::cli
