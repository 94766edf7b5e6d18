#include "stereo/coarse/scanline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stereo/coarse/path_memory.hpp"
#include "stereo/coarse/path_winner.hpp"

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
  for (int u = 0; u < row.columns; ++u) {
    float* cost = row.costs + u * row.pitch;
    for (int d = std::max(0, u - row.first_seen + 1); d < row.disparities; ++d) cost[d] = uncorrelated_cost;
    if (!std::isnan(prior.centre[u]) && prior.weight[u] > 0) {
      const Float centre = hn::Set(df, prior.centre[u]), weight = hn::Set(df, prior.weight[u]);
      const Float truncation = hn::Set(df, prior.truncation[u]);
      for (int d = 0; d < row.disparities; d += lanes) {
        const Float here = hn::Add(hn::Iota(df, 0), hn::Set(df, static_cast<float>(d)));
        const Float away = hn::Min(hn::Abs(hn::Sub(here, centre)), truncation);
        hn::Store(hn::MulAdd(hn::Mul(weight, away), away, hn::Load(df, cost + d)), df, cost + d);
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

/// The two paths of a row: from the left to column u, and from the right to column columns − 1 − u.
struct RowPaths {
  const ScanlineCosts& row;
  const PathMemory& memory;
  PathEnd forward, backward;
};

HWY_INLINE PathEnd start_path(const float* totals, int disparities) {
  return {totals, hn::Set(Floats(), *std::min_element(totals, totals + disparities))};
}

HWY_INLINE RowPaths start_paths(const ScanlineCosts& row, const PathMemory& memory) {
  const int last = row.columns - 1;
  std::copy_n(row.costs, row.pitch, memory.forward);
  std::copy_n(row.costs + last * row.pitch, row.pitch, memory.last_totals[0]);
  std::fill_n(memory.backward + last * memory.pitch, row.pitch, 0.0f);
  return {row, memory, start_path(memory.forward, row.disparities), start_path(memory.last_totals[0], row.disparities)};
}

HWY_INLINE void extend_paths(int u, Float step, Float jump, RowPaths& paths) {
  const Floats df;
  const ScanlineCosts& row = paths.row;
  const PathMemory& memory = paths.memory;
  const int w = row.columns - 1 - u;
  const float *cost_forward = row.costs + u * row.pitch, *cost_backward = row.costs + w * row.pitch;
  float *to_forward = memory.forward + u * memory.pitch, *to_backward = memory.last_totals[u % 2];
  float* path_backward = memory.backward + w * memory.pitch;
  Float min_forward = hn::Set(df, infinite_cost), min_backward = min_forward;
  for (int d = 0; d < row.disparities; d += static_cast<int>(hn::Lanes(df))) {
    const Float total = hn::Add(hn::Load(df, cost_forward + d), transition_cost(paths.forward, d, step, jump));
    const Float path_cost = transition_cost(paths.backward, d, step, jump);
    const Float total_backward = hn::Add(hn::Load(df, cost_backward + d), path_cost);
    hn::Store(total, df, to_forward + d);
    hn::Store(path_cost, df, path_backward + d);
    hn::Store(total_backward, df, to_backward + d);
    min_forward = hn::Min(min_forward, total);
    min_backward = hn::Min(min_backward, total_backward);
  }
  paths.forward = {to_forward, hn::MinOfLanes(df, min_forward)};
  paths.backward = {to_backward, hn::MinOfLanes(df, min_backward)};
}

/// Writes the smallest of the first `count` totals of column u. `totals` is scratch memory.
HWY_INLINE void take_winner(const float* forward, const float* backward, int count, float* totals, const float* costs,
                            int u, const PathWinners& winners) {
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
  const int before = std::max(winner - 1, 0), after = std::min(winner + 1, count - 1);
  winners.disparity[u] = static_cast<float>(winner);
  winners.inside[u] = after - before == 2 ? 1.0f : 0.0f;
  winners.before[u] = totals[before];
  winners.at[u] = totals[winner];
  winners.after[u] = totals[after];
  winners.own_before[u] = costs[before];
  winners.own_at[u] = costs[winner];
  winners.own_after[u] = costs[after];
}

HWY_INLINE void take_winners(const ScanlineCosts& row, const ScanlinePrior& prior, const PathMemory& memory,
                             float* HWY_RESTRICT disparity) {
  const PathWinners& winners = memory.winners;
  int u = 0;
  for (; u < row.columns && u < row.first_seen; ++u) disparity[u] = std::numeric_limits<float>::quiet_NaN();
  const int first = u;
  for (; u < row.columns; ++u) {
    const int count = std::min(row.disparities, u - row.first_seen + 1);
    take_winner(memory.forward + u * memory.pitch, memory.backward + u * memory.pitch, count, memory.last_totals[0],
                row.costs + u * row.pitch, u, winners);
  }
  for (u = first; u < row.columns; ++u) {
    const PathWinner winner{winners.disparity[u],  winners.before[u], winners.at[u],       winners.after[u],
                            winners.own_before[u], winners.own_at[u], winners.own_after[u]};
    const float fraction = fraction_of(winner, {prior.centre[u], prior.weight[u], prior.truncation[u]});
    disparity[u] = winner.disparity + winners.inside[u] * fraction;
  }
}

PathMemory memory_of(const Scanline& row) {
  return {row.costs.columns, row.costs.pitch, row.scratch};
}

void optimise_scanlines(const Scanline* rows, int count, const ScanlinePenalties& penalties, float uncorrelated_cost) {
  const Floats df;
  const Float step = hn::Set(df, penalties.step), jump = hn::Set(df, penalties.jump);
  for (int k = 0; k < count; ++k) complete_costs(rows[k].costs, rows[k].prior, uncorrelated_cost);
  const int columns = rows[0].costs.columns;
  const PathMemory first_memory = memory_of(rows[0]), second_memory = memory_of(rows[count - 1]);
  RowPaths first = start_paths(rows[0].costs, first_memory);
  // A step of every path in each turn: chains that hide each other's latency.
  if (count == 1) {
    for (int u = 1; u < columns; ++u) extend_paths(u, step, jump, first);
  } else {
    RowPaths second = start_paths(rows[1].costs, second_memory);
    for (int u = 1; u < columns; ++u) {
      extend_paths(u, step, jump, first);
      extend_paths(u, step, jump, second);
    }
  }
  take_winners(rows[0].costs, rows[0].prior, first_memory, rows[0].disparity);
  if (count > 1) take_winners(rows[1].costs, rows[1].prior, second_memory, rows[1].disparity);
}

}  // namespace roadstereo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo {

HWY_EXPORT(optimise_scanlines);

std::size_t scanline_scratch(int columns, std::ptrdiff_t pitch) {
  return static_cast<std::size_t>((2 * columns + 2) * (pitch + scanline_guard) + scanline_guard +
                                  PathWinners::arrays * columns);
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

void optimise_scanlines(const Scanline* rows, int count, const ScanlinePenalties& penalties, float uncorrelated_cost) {
  HWY_DYNAMIC_DISPATCH(optimise_scanlines)(rows, count, penalties, uncorrelated_cost);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
