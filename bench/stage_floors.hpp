#pragma once

#include "roadstereo/pipeline.hpp"

namespace roadstereo::bench {

/// What a GPU can do in a second, from what its driver says of it; 0: nothing.
struct Peak {
  double bytes;         ///< of global memory
  double operations;    ///< in single precision; a multiply-add is one
  double shared_bytes;  ///< of all multiprocessors
};

/// Of the current device.
Peak device_peak();

/// The least milliseconds that the stages of a frame can take: what the heads of the .cu files count, over the peak. A
/// stage is held up by the slowest of memory, operations and shared memory. Matching counts the whole range: what
/// search ranges leave out of it is known to the device alone.
StageTimes stage_floors(const PipelineOptions& options, int width, int height, int disparities, const Peak& peak);

}  // namespace roadstereo::bench
