#include "stereo/coarse/scanline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stereo/coarse/path_winner.hpp"

#ifndef ROADSTEREO_SCANLINE_PATH_MEMORY
#define ROADSTEREO_SCANLINE_PATH_MEMORY  // once for all instruction sets
namespace roadstereo {
namespace {

/// Where the totals of the paths are kept.
struct PathMemory {
  std::ptrdiff_t pitch;   ///< disparities and guards
  float* last_totals[2];  ///< totals of the paths from the right, of the last two columns alternately
  float* forward;         ///< totals of the paths from the left, `pitch` elements a column
  float* backward;        ///< costs of the paths from the right, without the column's own

  PathMemory(int columns, std::ptrdiff_t disparities, float* scratch)
      : pitch(disparities + scanline_guard),
        last_totals{scratch + scanline_guard, scratch + scanline_guard + pitch},
        forward(last_totals[1] + pitch),
        backward(forward + columns * pitch) {}
};

}  // namespace
}  // namespace roadstereo
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stereo/coarse/scanline.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace roadstereo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Float = hn::Vec<Floats>;

constexpr float infinite_cost = std::numeric_limits<float>::infinity();

/// Completes the costs: priors, disparities without a counterpart, and those behind the last.
HWY_INLINE void complete_costs(const ScanlineCosts& row, const ScanlinePrior& prior, float uncorrelated_cost) {
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Float truncation = hn::Set(df, prior.truncation);
  for (int u = 0; u < row.columns; ++u) {
    float* cost = row.costs + u * row.pitch;
    for (int d = std::max(0, u - row.first_seen + 1); d < row.disparities; ++d) cost[d] = uncorrelated_cost;
    if (!std::isnan(prior.centre[u])) {
      const Float centre = hn::Set(df, prior.centre[u]), weight = hn::Set(df, prior.weight[u]);
      for (int d = 0; d < row.disparities; d += lanes) {
        const Float here = hn::Add(hn::Iota(df, 0), hn::Set(df, static_cast<float>(d)));
        const Float away = hn::Min(hn::Abs(hn::Sub(here, centre)), truncation);
        hn::Store(hn::MulAdd(weight, away, hn::Load(df, cost + d)), df, cost + d);
      }
    }
    std::fill(cost + row.disparities, cost + row.pitch, infinite_cost);
  }
}

/// Total costs of the cheapest paths so far that end at each disparity of a column; the cheapest of all.
struct PathEnd {
  const float* totals;
  Float cheapest;
};

/// Cheapest transition from a path's end to the disparities from d on of the next column: stay, step by one, or jump.
HWY_INLINE Float transition_cost(const PathEnd& end, int d, Float step, Float jump) {
  const Floats df;
  const float* at = end.totals + d;
  const Float stay = hn::Sub(hn::LoadU(df, at), end.cheapest);
  const Float change = hn::Sub(hn::Min(hn::LoadU(df, at - 1), hn::LoadU(df, at + 1)), end.cheapest);
  return hn::Min(hn::Min(stay, hn::Add(change, step)), jump);
}

/// One step from the left and one from the right in each turn: two chains that hide each other's latency.
HWY_INLINE void aggregate_scanlines(const ScanlineCosts& row, const ScanlinePenalties& penalties,
                                    const PathMemory& memory) {
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Float step = hn::Set(df, penalties.step), jump = hn::Set(df, penalties.jump);
  const int last = row.columns - 1;
  PathEnd forward{memory.forward, hn::Zero(df)}, backward{memory.last_totals[0], hn::Zero(df)};
  std::copy_n(row.costs, row.pitch, memory.forward);
  std::copy_n(row.costs + last * row.pitch, row.pitch, memory.last_totals[0]);
  std::fill_n(memory.backward + last * memory.pitch, row.pitch, 0.0f);
  forward.cheapest = hn::Set(df, *std::min_element(memory.forward, memory.forward + row.disparities));
  backward.cheapest = hn::Set(df, *std::min_element(memory.last_totals[0], memory.last_totals[0] + row.disparities));
  for (int u = 1; u < row.columns; ++u) {
    const int w = last - u;
    const float *cost_forward = row.costs + u * row.pitch, *cost_backward = row.costs + w * row.pitch;
    float *to_forward = memory.forward + u * memory.pitch, *to_backward = memory.last_totals[u % 2];
    float* path_backward = memory.backward + w * memory.pitch;
    Float min_forward = hn::Set(df, infinite_cost), min_backward = min_forward;
    for (int d = 0; d < row.disparities; d += lanes) {
      const Float total = hn::Add(hn::Load(df, cost_forward + d), transition_cost(forward, d, step, jump));
      const Float path_cost = transition_cost(backward, d, step, jump);
      const Float total_backward = hn::Add(hn::Load(df, cost_backward + d), path_cost);
      hn::Store(total, df, to_forward + d);
      hn::Store(path_cost, df, path_backward + d);
      hn::Store(total_backward, df, to_backward + d);
      min_forward = hn::Min(min_forward, total);
      min_backward = hn::Min(min_backward, total_backward);
    }
    forward = {to_forward, hn::MinOfLanes(df, min_forward)};
    backward = {to_backward, hn::MinOfLanes(df, min_backward)};
  }
}

/// Returns the smallest of the first `count` totals of a column, with its fraction. `totals` is scratch memory.
HWY_INLINE float take_winner(const float* forward, const float* backward, int count, float* totals) {
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Float end = hn::Set(df, static_cast<float>(count));
  Float smallest = hn::Set(df, infinite_cost);
  for (int d = 0; d < count; d += lanes) {
    const Float here = hn::Add(hn::Iota(df, 0), hn::Set(df, static_cast<float>(d)));
    const Float sum = hn::Add(hn::Load(df, forward + d), hn::Load(df, backward + d));
    const Float total = hn::IfThenElse(hn::Lt(here, end), sum, hn::Set(df, infinite_cost));
    hn::Store(total, df, totals + d);
    smallest = hn::Min(smallest, total);
  }
  smallest = hn::MinOfLanes(df, smallest);
  int winner = 0;
  for (int d = 0; d < count; d += lanes) {
    const auto found = hn::FindFirstTrue(df, hn::Eq(hn::Load(df, totals + d), smallest));
    if (found < 0) continue;
    winner = d + static_cast<int>(found);
    break;
  }
  const bool inside = winner > 0 && winner + 1 < count;
  const float before = inside ? totals[winner - 1] : infinite_cost, after = inside ? totals[winner + 1] : infinite_cost;
  return winner_with_fraction(winner, count, before, totals[winner], after);
}

void optimise_scanline(const ScanlineCosts& row, const ScanlinePrior& prior, const ScanlinePenalties& penalties,
                       float uncorrelated_cost, float* scratch, float* disparity) {
  complete_costs(row, prior, uncorrelated_cost);
  const PathMemory memory(row.columns, row.pitch, scratch);
  aggregate_scanlines(row, penalties, memory);
  for (int u = 0; u < row.columns; ++u) {
    const int count = std::min(row.disparities, u - row.first_seen + 1);
    disparity[u] = count > 0 ? take_winner(memory.forward + u * memory.pitch, memory.backward + u * memory.pitch, count,
                                           memory.last_totals[0])
                             : std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(optimise_scanline);

std::size_t scanline_scratch(int columns, std::ptrdiff_t pitch) {
  return static_cast<std::size_t>((2 * columns + 2) * (pitch + scanline_guard) + scanline_guard);
}

void guard_scanline_scratch(int columns, std::ptrdiff_t pitch, int disparities, float* scratch) {
  constexpr float infinite_cost = std::numeric_limits<float>::infinity();
  const PathMemory memory(columns, pitch, scratch);
  for (float* column = memory.last_totals[0]; column < memory.backward; column += memory.pitch) {
    std::fill(column - scanline_guard, column, infinite_cost);
    // The paths' totals are written by whole vectors, which may end with the last disparity.
    std::fill(column + disparities, column + pitch, infinite_cost);
  }
  std::fill_n(memory.backward - scanline_guard, scanline_guard, infinite_cost);
}

void optimise_scanline(const ScanlineCosts& row, const ScanlinePrior& prior, const ScanlinePenalties& penalties,
                       float uncorrelated_cost, float* scratch, float* disparity) {
  HWY_DYNAMIC_DISPATCH(optimise_scanline)(row, prior, penalties, uncorrelated_cost, scratch, disparity);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
