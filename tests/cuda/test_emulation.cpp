// The imitation of a GPU that the kernels are checked with: it must notice what CUDA forbids. That it runs what CUDA
// runs is the matter of test_block.cpp.

#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "core/cuda/device.hpp"
#include "core/cuda/launch.hpp"
#include "core/cuda/memory.hpp"
#include "roadstereo/error.hpp"

namespace roadstereo::cuda {
namespace {

/// What no GPU may run: half of the block waits at a barrier that the others never reach.
void diverge() {
  if (threadIdx.x < 40) __syncthreads();
}

TEST(CudaEmulation, ReportsBarrierThatSomeThreadsMiss) {
  EXPECT_THROW(launch("diverge", diverge, {1, 64}, nullptr), std::logic_error);
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
    launch("race", race, {1, 64, 64 * sizeof(int)}, nullptr, out.data());
    std::exit(0);
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(66), "data race.*\n.*\n.*race");
}
#else
TEST(CudaEmulation, MissingBarrierChangesResult) {
  std::vector<int> out(64);
  launch("race", race, {1, 64, 64 * sizeof(int)}, nullptr, out.data());
  EXPECT_EQ(out[5], -1);  // bytes 0xFF: nothing was written yet
}
#endif

#if defined(__SANITIZE_ADDRESS__)
/// After a barrier, which leaves and enters every thread's stack again, the last thread writes one element too far.
void write_beyond(int* array, int elements) {
  int of_thread[4] = {1, 2, 3, 4};
  int* written = array != nullptr ? array : of_thread;
  __syncthreads();
  written[threadIdx.x + 1 < blockDim.x ? 0 : elements] = 5;
  __syncthreads();
}

TEST(CudaEmulationDeathTest, AddressSanitizerSeesWhatThreadsWrite) {
  std::vector<int> array(64);
  const auto run = [](int* written, int elements) {
    launch("write_beyond", write_beyond, {1, 64}, nullptr, written, elements);
    std::exit(0);
  };
  EXPECT_EXIT(run(nullptr, 3), testing::ExitedWithCode(0), "");
  EXPECT_DEATH(run(nullptr, 4), "stack-buffer-overflow");
  EXPECT_DEATH(run(array.data(), 64), "heap-buffer-overflow");
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

TEST(CudaEmulation, BlockHasAtMost48KilobytesOfSharedMemory) {
  EXPECT_THROW(launch("race", race, {1, 64, (48U << 10) + 1}, nullptr, nullptr), Error);
}

TEST(CudaEmulation, ClearedMemoryIsZero) {
  DeviceArray<int> array(3);
  EXPECT_EQ(array.data()[0], -1);
  reserve_cleared(array, 4, nullptr);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(array.data()[i], 0);
}

TEST(CudaEmulation, IsUsableDevice) {
  const Device device = find_device();
  EXPECT_TRUE(device.usable);
  EXPECT_EQ(device.reason, "");
}

}  // namespace
}  // namespace roadstereo::cuda
