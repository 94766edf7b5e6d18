#include "stereo/coarse/road_weights.hpp"

#include <algorithm>
#include <cmath>

#include "stereo/coarse/road_plausibility.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stereo/coarse/road_weights.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Plausibility of the road from the first `count` costs of a pixel.
HWY_INLINE float plausibility(const float* costs, int count, float road) {
  const hn::CappedTag<float, 16> df;
  using Float = hn::Vec<decltype(df)>;
  const NearRoad near = near_road(road, count);
  const Float first = hn::Set(df, static_cast<float>(near.first)), end = hn::Set(df, static_cast<float>(near.end));
  const Float last = hn::Set(df, static_cast<float>(count)), uncorrelated = hn::Set(df, uncorrelated_cost);
  Float at_road = uncorrelated, smallest = uncorrelated;
  for (int d = 0; d < count; d += static_cast<int>(hn::Lanes(df))) {
    const Float here = hn::Add(hn::Iota(df, 0), hn::Set(df, static_cast<float>(d)));
    const Float cost = hn::IfThenElse(hn::Lt(here, last), hn::Load(df, costs + d), uncorrelated);
    const auto is_near = hn::And(hn::Ge(here, first), hn::Lt(here, end));
    smallest = hn::Min(smallest, cost);
    at_road = hn::Min(at_road, hn::IfThenElse(is_near, cost, uncorrelated));
  }
  return cost_plausibility(hn::GetLane(hn::MinOfLanes(df, at_road)), hn::GetLane(hn::MinOfLanes(df, smallest)));
}

void apply_road_plausibility(const ScanlineCosts& row, const float* centre, const float* uncertainty, float* weight) {
  for (int u = 0; u < row.columns; ++u) {
    const int count = std::min(row.disparities, u - row.first_seen + 1);
    if (std::isnan(centre[u]) || count <= 0 || uncertainty[u] < min_uncertainty) continue;
    weight[u] *= plausibility(row.costs + u * row.pitch, count, centre[u]);
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(apply_road_plausibility);

void apply_road_plausibility(const ScanlineCosts& row, const float* centre, const float* uncertainty, float* weight) {
  HWY_DYNAMIC_DISPATCH(apply_road_plausibility)(row, centre, uncertainty, weight);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
