// What the threads of a block do together: sums, extremes and order statistics, against the host's.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/cuda/block_reduce.hpp"
#include "core/cuda/block_select.hpp"
#include "core/cuda/launch.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo::cuda {
namespace {

template <int count>
void sum_powers(int items, double* sums) {
  double own[count] = {};
  for (int i = static_cast<int>(threadIdx.x); i < items; i += static_cast<int>(blockDim.x)) {
    for (int k = 0; k < count; ++k) own[k] += (k + 1) * i;
  }
  const double* totals = block_sums(own, shared_memory<double>());
  // Again at once: nobody may still be reading the first.
  const double* again = block_sums(own, shared_memory<double>());
  for (int k = 0; k < count; ++k) {
    if (threadIdx.x == static_cast<unsigned>(k)) sums[k] = (totals[k] + again[k]) / 2;
  }
}

template <int count>
void expect_sums(unsigned threads) {
  constexpr int items = 777;
  std::vector<double> sums(count);
  launch(sum_powers<count>, {1, threads, sums_scratch(count) * sizeof(double)}, nullptr, items, sums.data());
  for (int k = 0; k < count; ++k) {
    EXPECT_EQ(sums[static_cast<std::size_t>(k)], (k + 1) * items * (items - 1) / 2.0) << k << " of " << count;
  }
}

TEST(CudaBlock, SumsEveryNumberOfValuesAndWarps) {
  for (const unsigned threads : {32U, 96U, 1024U}) {
    expect_sums<1>(threads);
    expect_sums<2>(threads);
    expect_sums<3>(threads);
    expect_sums<5>(threads);
    expect_sums<6>(threads);
    expect_sums<9>(threads);
    expect_sums<10>(threads);
    expect_sums<32>(threads);
  }
}

void extremes(const float* values, float* found) {
  float* scratch = shared_memory<float>();
  const float value = values[threadIdx.x];
  const float least = block_best(value, Least{}, scratch);
  const float greatest = block_best(value, Greatest{}, scratch);
  if (threadIdx.x == 7) found[0] = least;
  if (threadIdx.x == 8) found[1] = greatest;
}

TEST(CudaBlock, FindsMinimumAndMaximum) {
  std::vector<float> values(160), found(2);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<float>(test::lattice(1, static_cast<std::int64_t>(i), 3)) - 0.5F;
  launch(extremes, {1, 160, (warp_lanes + 1) * sizeof(float)}, nullptr, values.data(), found.data());
  EXPECT_EQ(found[0], *std::min_element(values.begin(), values.end()));
  EXPECT_EQ(found[1], *std::max_element(values.begin(), values.end()));
}

template <class RankOf>
void select(const float* values, int count, RankOf rank_of, float* found, int* of) {
  const auto key = [&](int i, std::uint32_t& out) {
    out = key_of(values[i]);
    return values[i] == values[i];
  };
  const SelectedKey selected = block_select(count, key, rank_of, *shared_memory<SelectScratch>());
  if (threadIdx.x != 0) return;
  *found = value_of(selected.key);
  *of = selected.of;
}

/// Values of both signs and many magnitudes, some equal, some missing.
std::vector<float> scattered(int count) {
  std::vector<float> values;
  for (int i = 0; i < count; ++i) {
    const double chance = test::lattice(i, 1, 5);
    const double value = std::pow(10, 6 * test::lattice(i, 2, 5) - 4) * (chance < 0.4 ? -1 : 1);
    values.push_back(chance > 0.9 ? NAN : chance > 0.6 ? 0.25F : static_cast<float>(value));
  }
  return values;
}

TEST(CudaBlock, SelectsExactOrderStatistics) {
  for (const int count : {1, 2, 33, 500, 3001}) {
    const std::vector<float> values = scattered(count);
    std::vector<float> sorted;
    std::copy_if(values.begin(), values.end(), std::back_inserter(sorted), [](float v) { return !std::isnan(v); });
    std::sort(sorted.begin(), sorted.end());
    for (const double share : {0.0, 0.01, 0.3, 0.95, 1.0}) {
      float found = 0;
      int of = 0;
      launch(select<ShareRank>, {1, 128, sizeof(SelectScratch)}, nullptr, values.data(), count, ShareRank{share},
             &found, &of);
      ASSERT_EQ(of, static_cast<int>(sorted.size()));
      EXPECT_EQ(found, sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))]);
    }
    float middle = 0;
    int of = 0;
    launch(select<MiddleRank>, {1, 128, sizeof(SelectScratch)}, nullptr, values.data(), count, MiddleRank{}, &middle,
           &of);
    EXPECT_EQ(middle, sorted[sorted.size() / 2]);
  }
}

TEST(CudaBlock, SelectsNothingOfNoValues) {
  const std::vector<float> values(40, NAN);
  float found = 0;
  int of = -1;
  launch(select<MiddleRank>, {1, 64, sizeof(SelectScratch)}, nullptr, values.data(), 40, MiddleRank{}, &found, &of);
  EXPECT_EQ(of, 0);
}

}  // namespace
}  // namespace roadstereo::cuda
