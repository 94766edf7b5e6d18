#include "stereo/cpu/aggregation.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stereo/cpu/aggregation.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
//
#include <hwy/highway.h>

#include "stereo/cpu/aggregation-inl.hpp"
#include "stereo/cpu/winner_take_all-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace roadstereo::cpu::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void aggregate_and_choose(const AggregationRow& row, const AggregationScratch& scratch, const WinnerRow& out) {
  const int lanes = static_cast<int>(hn::Lanes(Floats()));
  float* energies = scratch.numbers;
  float* inverse_sums = energies + strip_columns * row.pitch;
  StepList steps{.cost = scratch.pointers, .weights = inverse_sums + strip_columns, .inverse_sums = inverse_sums};
  if (row.radius > 0) list_steps(row, steps);
  for (int strip = row.first; strip < row.end; strip += strip_columns) {
    if (row.radius > 0) gather_weights(row, strip, steps);
    int d = 0;
    for (; d + lanes < row.disparities; d += 2 * lanes) aggregate_strip<2>(row, steps, strip, d, energies);
    if (d < row.disparities) aggregate_strip<1>(row, steps, strip, d, energies);
    const int columns = std::min(strip_columns, row.end - strip);
    StripWinners found;
    find_winners(row, strip, energies, columns, found);
    write_winners(row, strip, columns, found, out);
  }
}

const char* name_of_target() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace roadstereo::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace roadstereo::cpu {

HWY_EXPORT(aggregate_and_choose);
HWY_EXPORT(name_of_target);

AggregationScratchSize aggregation_scratch(int window_rows, int taps, std::ptrdiff_t pitch) {
  const std::ptrdiff_t steps = taps + window_rows;
  return {steps, strip_columns * (pitch + 1 + steps)};
}

void aggregate_and_choose(const AggregationRow& row, const AggregationScratch& scratch, const WinnerRow& out) {
  HWY_DYNAMIC_DISPATCH(aggregate_and_choose)(row, scratch, out);
}

std::string target_name() {
  return HWY_DYNAMIC_DISPATCH(name_of_target)();
}

}  // namespace roadstereo::cpu
#endif  // HWY_ONCE
