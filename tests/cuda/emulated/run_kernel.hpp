#pragma once

#include <cstddef>
#include <functional>

#include "types.h"

/// Runs kernels on the host, one thread after the other: a machine without a GPU checks with it what the kernels
/// compute. Blocks run one after the other; the threads of a block take turns at their barriers, forth and back, so
/// that a missing barrier shows. Shared and device memory begin as bytes 0xFF, and are as large as was asked for, so
/// that the address sanitizer sees what compute-sanitizer's memcheck would. To the thread sanitizer the threads of a
/// block are threads that only their barriers and atomics order: it sees what racecheck would, in device memory too.
namespace roadstereo::cuda::emulated {

/// Throws std::logic_error when the threads of a block wait for each other at different barriers, or for one that
/// ended.
void run_kernel(dim3 grid, dim3 block, std::size_t shared_bytes, const std::function<void()>& thread);

/// Shared memory of the block that runs.
void* shared_memory();

/// Lets so many launches of this thread run, and the next one fail with std::runtime_error; negative: none fails.
void fail_after(int launches);

/// Calls of cudaMalloc and cudaHostAlloc so far, of the whole process.
std::size_t allocations();

/// Streams of the process that were not waited for since the last copy was enqueued there.
int streams_with_copies();

}  // namespace roadstereo::cuda::emulated
