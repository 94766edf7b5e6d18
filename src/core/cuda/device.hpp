#pragma once

#include <string>

namespace roadstereo::cuda {

/// Whether kernels run on the host, in whose memory then all is.
#if defined(ROADSTEREO_CUDA_EMULATED)
inline constexpr bool is_emulated = true;
#else
inline constexpr bool is_emulated = false;
#endif

/// The GPU of this process, or why it cannot use one.
struct Device {
  bool usable = false;
  std::string name;    ///< e.g. "NVIDIA H200 (compute capability 9.0)"; empty when not usable
  std::string reason;  ///< why not, as a sentence; empty when usable
  int index = 0;
  int multiprocessors = 0;
  bool programmatic_launch = false;  ///< kernels may begin before the last one has ended (begin_kernel())
};

/// Asks the driver for the current device, and whether this binary carries code for it.
Device find_device();

/// Throws Error unless this is the current device of this thread: each thread has its own, at first 0.
void require_current_device(int index);

}  // namespace roadstereo::cuda
