// What the threads of a warp and of a block do together: sums, extremes and order statistics, against the host's. All
// fits rest on it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <vector>

#include "tests/cuda/block_kernels.hpp"
#include "tests/cuda/device_copy.hpp"
#include "tests/cuda/device_test.hpp"
#include "tests/stereo/textured_pair.hpp"

namespace roadstereo {
namespace {

class CudaBlock : public test::OnDevice {};

TEST_F(CudaBlock, SumsEveryNumberOfValuesAndWarps) {
  constexpr int items = 777;
  for (const unsigned threads : {32U, 96U, 1024U}) {
    for (const int count : {1, 2, 3, 5, 6, 9, 10, 32}) {
      const auto size = static_cast<std::size_t>(count);
      cuda::DeviceArray<double> on_device(size);
      test::sum_multiples(count, threads, items, on_device.data());
      const std::vector<double> sums = test::to_host(on_device.data(), size);
      for (std::size_t k = 0; k < size; ++k) {
        EXPECT_EQ(sums[k], static_cast<double>(k + 1) * items * (items - 1) / 2.0) << k << " of " << count;
      }
    }
  }
}

TEST_F(CudaBlock, FindsMinimumAndMaximum) {
  std::vector<float> values(160);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<float>(test::lattice(1, static_cast<std::int64_t>(i), 3)) - 0.5F;
  const auto in = test::to_device(values);
  cuda::DeviceArray<float> out(2);
  test::find_extremes(in.data(), 160, out.data());
  const std::vector<float> found = test::to_host(out.data(), 2);
  EXPECT_EQ(found[0], *std::min_element(values.begin(), values.end()));
  EXPECT_EQ(found[1], *std::max_element(values.begin(), values.end()));
}

constexpr double shares[] = {-1, 0.0, 0.01, 0.3, 0.95, 1.0};

/// The value of the rank, on the host.
float expected_of(const std::vector<float>& values, double share) {
  std::vector<float> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted), [](float v) { return !std::isnan(v); });
  std::sort(sorted.begin(), sorted.end());
  const double rank =
      share < 0 ? static_cast<double>(sorted.size() / 2) : share * static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(rank)];
}

int count_of(const std::vector<float>& values) {
  return static_cast<int>(std::count_if(values.begin(), values.end(), [](float v) { return !std::isnan(v); }));
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

TEST_F(CudaBlock, SelectsExactOrderStatistics) {
  cuda::DeviceArray<test::Selected> out(1);
  for (const int count : {1, 2, 33, 500, 3001}) {
    const std::vector<float> values = scattered(count);
    const auto in = test::to_device(values);
    for (const double share : shares) {
      const unsigned threads = count > 1024 ? 480 : 128;
      test::select_value(in.data(), count, threads, {share}, out.data());
      const test::Selected selected = test::to_host(out.data(), 1).front();
      ASSERT_EQ(selected.of, count_of(values));
      EXPECT_EQ(selected.value, expected_of(values, share)) << share << " of " << count;
    }
  }
}

TEST_F(CudaBlock, SelectsSeveralRanksAtOnce) {
  cuda::DeviceArray<test::Selected> out(3);
  for (const int count : {5, 33, 500, 3001}) {
    const std::vector<float> values = scattered(count);
    std::vector<float> positive;
    std::copy_if(values.begin(), values.end(), std::back_inserter(positive), [](float v) { return v > 0; });
    const auto in = test::to_device(values);
    test::select_ranks_of_two_sets(in.data(), count, count > 1024 ? 480 : 128, {{0.05}, {0.95}, {-1}}, out.data());
    const std::vector<test::Selected> selected = test::to_host(out.data(), 3);
    EXPECT_EQ(selected[0].of, count_of(values)) << count;
    EXPECT_EQ(selected[1].of, count_of(values)) << count;
    ASSERT_EQ(selected[2].of, count_of(positive)) << count;
    EXPECT_EQ(selected[0].value, expected_of(values, 0.05)) << count;
    EXPECT_EQ(selected[1].value, expected_of(values, 0.95)) << count;
    EXPECT_EQ(selected[2].value, expected_of(positive, -1)) << count;
  }
}

/// Whole numbers of two digits, whose first ones others have counted.
TEST_F(CudaBlock, SelectsNumbersWhoseFirstDigitsAreCounted) {
  constexpr int count = 2000, bins = 2048;
  std::vector<float> values;
  std::vector<int> first_digits(bins);
  for (int i = 0; i < count; ++i) {
    const double chance = test::lattice(i, 3, 5);
    values.push_back(chance < 0.1 ? NAN : static_cast<float>(std::floor((1 << 22) * chance * chance)));
    if (chance >= 0.1) ++first_digits[static_cast<std::size_t>(values.back()) / bins];
  }
  const auto in = test::to_device(values);
  const auto counted = test::to_device(first_digits);
  cuda::DeviceArray<test::Selected> out(1);
  for (const double share : shares) {
    test::select_number(in.data(), count, 256, {share}, counted.data(), out.data());
    const test::Selected selected = test::to_host(out.data(), 1).front();
    EXPECT_EQ(selected.of, count_of(values));
    EXPECT_EQ(selected.value, expected_of(values, share)) << share;
  }
}

TEST_F(CudaBlock, SelectsNothingOfNoValues) {
  const auto in = test::to_device(std::vector<float>(40, NAN));
  cuda::DeviceArray<test::Selected> out(1);
  test::select_value(in.data(), 40, 64, {}, out.data());
  EXPECT_EQ(test::to_host(out.data(), 1).front().of, 0);
}

TEST_F(CudaBlock, BarrierMakesSharedMemoryVisible) {
  std::vector<int> numbers(192);
  std::iota(numbers.begin(), numbers.end(), 0);
  const auto in = test::to_device(numbers);
  cuda::DeviceArray<int> out(192);
  test::reverse_in_blocks(in.data(), 3, 64, out.data());
  const std::vector<int> found = test::to_host(out.data(), 192);
  for (int i = 0; i < 192; ++i) EXPECT_EQ(found[static_cast<std::size_t>(i)], i / 64 * 64 + 63 - i % 64);
}

TEST_F(CudaBlock, LanesOfWarpReduceAndVote) {
  cuda::DeviceArray<test::WarpResults> out(64);
  test::reduce_warps(out.data());
  const std::vector<test::WarpResults> found = test::to_host(out.data(), 64);
  for (std::size_t t = 0; t < 64; ++t) {
    const bool second = t >= 32;
    EXPECT_EQ(found[t].sum, 31 * 32 / 2 + (second ? 32 * 32 : 0));
    EXPECT_EQ(found[t].votes, second ? 0x92492492U : 0x49249249U);  // multiples of 3 from 33 on, and from 0 on
    EXPECT_EQ(found[t].least, second ? -38.5F : -6.5F);
    EXPECT_EQ(found[t].least_cost, second ? -1e-7F : 10 - 1e-7F);  // of numbers 41 and 31
    EXPECT_EQ(found[t].largest, second ? -35 : -3);
  }
}

}  // namespace
}  // namespace roadstereo
