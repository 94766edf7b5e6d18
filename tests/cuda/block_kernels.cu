#include "core/cuda/block_reduce.hpp"
#include "core/cuda/block_select.hpp"
#include "core/cuda/launch.hpp"
#include "core/cuda/register_select.hpp"
#include "core/cuda/warp.hpp"
#include "tests/cuda/block_kernels.hpp"

namespace roadstereo::test {
namespace {

using namespace cuda;  // NOLINT(google-build-using-namespace): what is tested

template <int count>
__global__ void __launch_bounds__(1024) sum_of_block(int items, double* sums) {
  double own[count] = {};
  for (int i = static_cast<int>(threadIdx.x); i < items; i += static_cast<int>(blockDim.x)) {
    for (int k = 0; k < count; ++k) own[k] += (k + 1) * i;
  }
  const double* totals = block_sums(own, shared_memory<double>());
  double first[count];
  for (int k = 0; k < count; ++k) first[k] = totals[k];
  // Again at once: nobody may still be reading the first.
  const double* again = block_sums(own, shared_memory<double>());
  for (int k = 0; k < count; ++k) {
    if (threadIdx.x == static_cast<unsigned>(k)) sums[k] = (first[k] + again[k]) / 2;
  }
}

template <int count>
void launch_sum(unsigned threads, int items, double* sums) {
  launch("sum_of_block", sum_of_block<count>, {1, threads, sums_scratch(count) * sizeof(double)}, nullptr, items, sums);
}

__global__ void extremes_of_block(const float* values, float* found) {
  float* scratch = shared_memory<float>();
  const float value = values[threadIdx.x];
  const float least = block_best(value, Least{}, scratch);
  const float greatest = block_best(value, Greatest{}, scratch);
  if (threadIdx.x == 7) found[0] = least;
  if (threadIdx.x == 8) found[1] = greatest;
}

struct RankOf {
  Rank rank;
  __device__ int operator()(int count) const {
    return rank.share < 0 ? MiddleRank{}(count) : ShareRank{rank.share}(count);
  }
};

constexpr int values_of_thread = 8;

__global__ void value_of_rank(const float* values, int count, RankOf rank, Selected* selected) {
  RegisterSelect select(*shared_memory<RegisterSelectScratch>());
  std::uint32_t keys[values_of_thread];
  for (int k = 0; k < values_of_thread; ++k) {
    const int i = static_cast<int>(threadIdx.x) + k * static_cast<int>(blockDim.x);
    keys[k] = i < count && values[i] == values[i] ? key_of(values[i]) : RegisterSelect::no_key;
  }
  const SelectedKey found = select.select<RegisterSelect::float_digits>(keys, rank);
  // Again at once: nobody may still be counting the last digit, or reading its counts.
  const SelectedKey again = select.select<RegisterSelect::float_digits>(keys, rank);
  const bool same = found.key == again.key && found.of == again.of;
  if (threadIdx.x == blockDim.x - 1) *selected = {same ? value_of(found.key) : nanf(""), found.of};
}

struct ThreeRanks {
  RankOf of[3];
};

__global__ void values_of_ranks(const float* values, int count, ThreeRanks ranks, Selected* selected) {
  auto& scratch = *shared_memory<RanksScratch<3>>();
  std::uint32_t keys[2][values_of_thread];
  for (int k = 0; k < values_of_thread; ++k) {
    const int i = static_cast<int>(threadIdx.x) + k * static_cast<int>(blockDim.x);
    keys[0][k] = i < count && values[i] == values[i] ? key_of(values[i]) : RegisterSelect::no_key;
    keys[1][k] = i < count && values[i] > 0 ? key_of(values[i]) : RegisterSelect::no_key;
  }
  // Twice: nobody may still be reading what the first time left.
  SelectedKey found[3];
  for (int time = 0; time < 2; ++time) {
    const SelectedKey* of = select_ranks<RegisterSelect::float_digits, 0, 0, 1>(keys, ranks.of, scratch);
    for (int r = 0; r < 3; ++r) {
      const bool same = time == 0 || (of[r].key == found[r].key && of[r].of == found[r].of);
      found[r] = same ? of[r] : SelectedKey{0, -1};
    }
    __syncthreads();
  }
  if (threadIdx.x != blockDim.x - 1) return;
  for (int r = 0; r < 3; ++r) selected[r] = {value_of(found[r].key), found[r].of};
}

__global__ void number_of_rank(const float* values, int count, RankOf rank, const int* first_digits,
                               Selected* selected) {
  const auto key = [&](int i, std::uint32_t& out) {
    out = static_cast<std::uint32_t>(values[i]);
    return values[i] == values[i];
  };
  const SelectedKey found = block_select<4>(count, key, rank, first_digits, *shared_memory<SelectScratch>());
  if (threadIdx.x == 0) *selected = {static_cast<float>(found.key), found.of};
}

__global__ void reverse_block(const int* in, int* out) {
  int* shared = shared_memory<int>();
  const unsigned t = threadIdx.x, first = blockIdx.x * blockDim.x;
  shared[t] = in[first + t];
  __syncthreads();
  out[first + t] = shared[blockDim.x - 1 - t];
}

__global__ void reduce_warp(WarpResults* results) {
  const int number = static_cast<int>(threadIdx.x);
  int sum = number;
  for (int mask = warp_lanes / 2; mask > 0; mask /= 2) sum += __shfl_xor_sync(whole_warp, sum, mask);
  const float cost = number % 5 == 0 ? INFINITY : fabsf(static_cast<float>(number - 41)) - 1e-7F;
  results[number] = {sum, __ballot_sync(whole_warp, number % 3 == 0), warp_min(24.5F - static_cast<float>(number)),
                     warp_min_of_costs(cost), warp_max(-3 - number)};
}

}  // namespace

void sum_multiples(int count, unsigned threads, int items, double* sums) {
  switch (count) {
    case 1:
      return launch_sum<1>(threads, items, sums);
    case 2:
      return launch_sum<2>(threads, items, sums);
    case 3:
      return launch_sum<3>(threads, items, sums);
    case 5:
      return launch_sum<5>(threads, items, sums);
    case 6:
      return launch_sum<6>(threads, items, sums);
    case 9:
      return launch_sum<9>(threads, items, sums);
    case 10:
      return launch_sum<10>(threads, items, sums);
    default:
      return launch_sum<32>(threads, items, sums);
  }
}

void find_extremes(const float* values, unsigned threads, float* found) {
  launch("extremes_of_block", extremes_of_block, {1, threads, (warp_lanes + 1) * sizeof(float)}, nullptr, values,
         found);
}

void select_value(const float* values, int count, unsigned threads, Rank rank, Selected* selected) {
  launch("value_of_rank", value_of_rank, {1, threads, sizeof(RegisterSelectScratch)}, nullptr, values, count,
         RankOf{rank}, selected);
}

void select_ranks_of_two_sets(const float* values, int count, unsigned threads, const Rank (&ranks)[3],
                              Selected* selected) {
  launch("values_of_ranks", values_of_ranks, {1, threads, sizeof(RanksScratch<3>)}, nullptr, values, count,
         ThreeRanks{{{ranks[0]}, {ranks[1]}, {ranks[2]}}}, selected);
}

void select_number(const float* values, int count, unsigned threads, Rank rank, const int* first_digits,
                   Selected* selected) {
  launch("number_of_rank", number_of_rank, {1, threads, sizeof(SelectScratch)}, nullptr, values, count, RankOf{rank},
         first_digits, selected);
}

void reverse_in_blocks(const int* in, unsigned blocks, unsigned threads, int* out) {
  launch("reverse_block", reverse_block, {blocks, threads, threads * sizeof(int)}, nullptr, in, out);
}

void reduce_warps(WarpResults* results) {
  launch("reduce_warp", reduce_warp, {1, 2 * warp_lanes}, nullptr, results);
}

}  // namespace roadstereo::test
