// The imitation of a GPU that the kernels are checked with: it must run what CUDA runs, and notice what CUDA forbids.

#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "core/cuda/device.hpp"
#include "core/cuda/launch.hpp"
#include "core/cuda/memory.hpp"
#include "core/cuda/warp.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cuda {
namespace {

/// Reverses numbers within blocks of 64 through shared memory.
void reverse(const int* in, int* out) {
  int* shared = shared_memory<int>();
  const unsigned t = threadIdx.x, first = blockIdx.x * blockDim.x;
  shared[t] = in[first + t];
  __syncthreads();
  out[first + t] = shared[blockDim.x - 1 - t];
}

TEST(CudaEmulation, BarrierMakesSharedMemoryVisible) {
  std::vector<int> in(192), out(192);
  std::iota(in.begin(), in.end(), 0);
  launch(reverse, {3, 64, 64 * sizeof(int)}, nullptr, in.data(), out.data());
  for (int i = 0; i < 192; ++i) EXPECT_EQ(out[static_cast<std::size_t>(i)], i / 64 * 64 + 63 - i % 64);
}

/// Sums a warp's lane numbers by exchanging halves.
void sum_lanes(int* sums) {
  int sum = static_cast<int>(threadIdx.x);
  for (int mask = 16; mask > 0; mask /= 2) sum += __shfl_xor_sync(0xFFFFFFFFU, sum, mask);
  sums[threadIdx.x] = sum;
}

TEST(CudaEmulation, LanesExchangeWithinWarp) {
  std::vector<int> sums(64);
  launch(sum_lanes, {1, 64}, nullptr, sums.data());
  for (std::size_t t = 0; t < 64; ++t) EXPECT_EQ(sums[t], t < 32 ? 31 * 32 / 2 : 31 * 32 / 2 + 32 * 32);
}

/// The smallest and the largest of a warp's numbers, as floats of both signs and as whole numbers.
void reduce(float* least, int* largest) {
  const int lane = static_cast<int>(threadIdx.x);
  least[lane] = warp_min(lane < 32 ? static_cast<float>(lane) - 7.5F : static_cast<float>(80 - lane));
  largest[lane] = warp_max(lane < 32 ? -lane - 3 : lane % 50);
}

TEST(CudaEmulation, ReducesWarp) {
  std::vector<float> least(64);
  std::vector<int> largest(64);
  launch(reduce, {1, 64}, nullptr, least.data(), largest.data());
  for (std::size_t t = 0; t < 64; ++t) {
    EXPECT_EQ(least[t], t < 32 ? -7.5F : 17.0F);
    EXPECT_EQ(largest[t], t < 32 ? -3 : 49);
  }
}

void vote(unsigned* votes) {
  votes[threadIdx.x] = __ballot_sync(0xFFFFFFFFU, threadIdx.x % 3 == 0);
}

TEST(CudaEmulation, BallotHoldsVotesOfLanes) {
  std::vector<unsigned> votes(32);
  launch(vote, {1, 32}, nullptr, votes.data());
  for (const unsigned v : votes) EXPECT_EQ(v, 0x49249249U);
}

/// What no GPU may run: half of the block waits at a barrier that the others never reach.
void diverge() {
  if (threadIdx.x < 40) __syncthreads();
}

TEST(CudaEmulation, ReportsBarrierThatSomeThreadsMiss) {
  EXPECT_THROW(launch(diverge, {1, 64}, nullptr), std::logic_error);
}

/// Without a barrier between writing and reading, what is read depends on whose turn it was.
void race(int* out) {
  int* shared = shared_memory<int>();
  shared[threadIdx.x] = static_cast<int>(threadIdx.x);
  out[threadIdx.x] = shared[(threadIdx.x + 1) % blockDim.x];
}

#if defined(__SANITIZE_THREAD__)
TEST(CudaEmulationDeathTest, MissingBarrierIsDataRace) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  std::vector<int> out(64);
  const auto run = [&] {
    launch(race, {1, 64, 64 * sizeof(int)}, nullptr, out.data());
    std::exit(0);
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(66), "data race.*\n.*\n.*race");
}
#else
TEST(CudaEmulation, MissingBarrierChangesResult) {
  std::vector<int> out(64);
  launch(race, {1, 64, 64 * sizeof(int)}, nullptr, out.data());
  EXPECT_EQ(out[5], -1);  // bytes 0xFF: nothing was written yet
}
#endif

TEST(CudaEmulation, ErrorNamesCallAndReason) {
  DeviceArray<float> array;
  try {
    array.reserve(std::size_t{1} << 40);
    FAIL();
  } catch (const SystemError& error) {
    EXPECT_EQ(std::string(error.what()),
              "CUDA: cudaMalloc(&memory, bytes) failed: out of memory (cudaErrorMemoryAllocation)");
  }
  array.reserve(4);  // and goes on after it
  EXPECT_NE(array.data(), nullptr);
}

TEST(CudaEmulation, IsUsableDevice) {
  const Device device = find_device();
  EXPECT_TRUE(device.usable);
  EXPECT_EQ(device.reason, "");
}

}  // namespace
}  // namespace roadstereo::cuda
