#include "stereo/coarse/scanline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

constexpr float never = std::numeric_limits<float>::infinity();

/// Completes the costs: guesses, disparities without a counterpart, and those behind the last.
HWY_INLINE void complete_costs(const ScanlineCosts& row, const ScanlineGuess& guess, float no_evidence) {
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Float reach = hn::Set(df, guess.reach);
  for (int u = 0; u < row.columns; ++u) {
    float* cost = row.costs + u * row.pitch;
    for (int d = std::max(0, u - row.first_seen + 1); d < row.disparities; ++d) cost[d] = no_evidence;
    if (!std::isnan(guess.centre[u])) {
      const Float centre = hn::Set(df, guess.centre[u]), pull = hn::Set(df, guess.pull[u]);
      for (int d = 0; d < row.disparities; d += lanes) {
        const Float here = hn::Add(hn::Iota(df, 0), hn::Set(df, static_cast<float>(d)));
        const Float away = hn::Min(hn::Abs(hn::Sub(here, centre)), reach);
        hn::Store(hn::MulAdd(pull, away, hn::Load(df, cost + d)), df, cost + d);
      }
    }
    std::fill(cost + row.disparities, cost + row.pitch, never);
  }
}

/// Total costs of the cheapest paths so far that end at each disparity of a column; the cheapest of all.
struct PathEnd {
  const float* totals;
  Float cheapest;
};

/// Cheapest way from a path's end to the disparities from d on of the next column: stay, step by one, or jump.
HWY_INLINE Float transition_cost(const PathEnd& end, int d, Float step, Float jump) {
  const Floats df;
  const float* at = end.totals + d;
  const Float stay = hn::Sub(hn::LoadU(df, at), end.cheapest);
  const Float change = hn::Sub(hn::Min(hn::LoadU(df, at - 1), hn::LoadU(df, at + 1)), end.cheapest);
  return hn::Min(hn::Min(stay, hn::Add(change, step)), jump);
}

/// Where the totals of the paths are kept.
struct PathMemory {
  float* forth;          ///< totals of the paths from the left, `pitch` elements a column
  float* back;           ///< ways of the paths from the right, without the column's own cost
  float* turns[2];       ///< totals of the paths from the right, of the last two columns in turn
  std::ptrdiff_t pitch;  ///< disparities and guards
};

HWY_INLINE PathMemory share_out(const ScanlineCosts& row, float* scratch) {
  PathMemory memory{};
  memory.pitch = row.pitch + scanline_guard;
  memory.turns[0] = scratch + scanline_guard;
  memory.turns[1] = memory.turns[0] + memory.pitch;
  memory.forth = memory.turns[1] + memory.pitch;
  memory.back = memory.forth + row.columns * memory.pitch;
  for (float* column = memory.turns[0]; column < memory.back; column += memory.pitch) {
    std::fill(column - scanline_guard, column, never);
    // The paths' totals are written by whole vectors, which may end with the last disparity.
    std::fill(column + row.disparities, column + row.pitch, never);
  }
  std::fill_n(memory.back - scanline_guard, scanline_guard, never);
  return memory;
}

/// One step from the left and one from the right in each turn: two chains that hide each other's latency.
HWY_INLINE void aggregate_scanlines(const ScanlineCosts& row, const ScanlinePenalties& penalties,
                                    const PathMemory& memory) {
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Float step = hn::Set(df, penalties.step), jump = hn::Set(df, penalties.jump);
  const int last = row.columns - 1;
  PathEnd forth{memory.forth, hn::Zero(df)}, back{memory.turns[0], hn::Zero(df)};
  std::copy_n(row.costs, row.pitch, memory.forth);
  std::copy_n(row.costs + last * row.pitch, row.pitch, memory.turns[0]);
  std::fill_n(memory.back + last * memory.pitch, row.pitch, 0.0f);
  forth.cheapest = hn::Set(df, *std::min_element(memory.forth, memory.forth + row.disparities));
  back.cheapest = hn::Set(df, *std::min_element(memory.turns[0], memory.turns[0] + row.disparities));
  for (int u = 1; u < row.columns; ++u) {
    const int w = last - u;
    const float *cost_forth = row.costs + u * row.pitch, *cost_back = row.costs + w * row.pitch;
    float *to_forth = memory.forth + u * memory.pitch, *to_back = memory.turns[u % 2];
    float* way_back = memory.back + w * memory.pitch;
    Float min_forth = hn::Set(df, never), min_back = min_forth;
    for (int d = 0; d < row.disparities; d += lanes) {
      const Float total = hn::Add(hn::Load(df, cost_forth + d), transition_cost(forth, d, step, jump));
      const Float way = transition_cost(back, d, step, jump);
      const Float total_back = hn::Add(hn::Load(df, cost_back + d), way);
      hn::Store(total, df, to_forth + d);
      hn::Store(way, df, way_back + d);
      hn::Store(total_back, df, to_back + d);
      min_forth = hn::Min(min_forth, total);
      min_back = hn::Min(min_back, total_back);
    }
    forth = {to_forth, hn::MinOfLanes(df, min_forth)};
    back = {to_back, hn::MinOfLanes(df, min_back)};
  }
}

/// The smallest of the first `count` totals of a column, with its fraction. `totals` is scratch memory.
HWY_INLINE float take_winner(const float* forth, const float* back, int count, float* totals) {
  const Floats df;
  const int lanes = static_cast<int>(hn::Lanes(df));
  const Float end = hn::Set(df, static_cast<float>(count));
  Float smallest = hn::Set(df, never);
  for (int d = 0; d < count; d += lanes) {
    const Float here = hn::Add(hn::Iota(df, 0), hn::Set(df, static_cast<float>(d)));
    const Float sum = hn::Add(hn::Load(df, forth + d), hn::Load(df, back + d));
    const Float total = hn::IfThenElse(hn::Lt(here, end), sum, hn::Set(df, never));
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
  const float before = inside ? totals[winner - 1] : never, after = inside ? totals[winner + 1] : never;
  return winner_with_fraction(winner, count, before, totals[winner], after);
}

void optimise_scanline(const ScanlineCosts& row, const ScanlineGuess& guess, const ScanlinePenalties& penalties,
                       float no_evidence, float* scratch, float* disparity) {
  complete_costs(row, guess, no_evidence);
  const PathMemory memory = share_out(row, scratch);
  aggregate_scanlines(row, penalties, memory);
  for (int u = 0; u < row.columns; ++u) {
    const int count = std::min(row.disparities, u - row.first_seen + 1);
    disparity[u] =
        count > 0 ? take_winner(memory.forth + u * memory.pitch, memory.back + u * memory.pitch, count, memory.turns[0])
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

void optimise_scanline(const ScanlineCosts& row, const ScanlineGuess& guess, const ScanlinePenalties& penalties,
                       float no_evidence, float* scratch, float* disparity) {
  HWY_DYNAMIC_DISPATCH(optimise_scanline)(row, guess, penalties, no_evidence, scratch, disparity);
}

}  // namespace roadstereo
#endif  // HWY_ONCE
