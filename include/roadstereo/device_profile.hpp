#pragma once

#include <cstddef>
#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace roadstereo {

/// A kernel in a frame.
struct KernelProfile {
  std::string name;
  int launches = 0;
  double ms = 0;         ///< of all launches
  int blocks = 0;        ///< of the first launch, as are the values below
  int threads = 0;       ///< of a block
  double occupancy = 0;  ///< threads resident on a multiprocessor at a time, as a share of the most it can hold, 0 … 1
  int registers = 0;     ///< of a thread
  int local_bytes = 0;   ///< of a thread: spilled registers, and arrays that are indexed
  int shared_bytes = 0;  ///< of a block
};

/// What a frame asked of the device.
struct DeviceProfile {
  std::vector<KernelProfile> kernels;  ///< in the order of their first launch
  int launches = 0;
  int waits = 0;               ///< number of times that the host waited for the device
  std::size_t bytes_up = 0;    ///< copied from the host to the device
  std::size_t bytes_down = 0;  ///< copied from the device to the host
};

}  // namespace roadstereo
#pragma GCC visibility pop
