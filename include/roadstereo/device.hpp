#pragma once

#include <cstdint>
#include <memory>

#include "roadstereo/device_profile.hpp"

struct CUstream_st;

#pragma GCC visibility push(default)
namespace roadstereo {

/// What is timed with the clock of the device. Each measurement takes the device about a microsecond.
enum class DeviceTiming {
  none,    ///< nothing: FrameResult::ms is the host's clock, on which a stage ends when it is enqueued
  stages,  ///< FrameResult::ms of every stage
  kernels  ///< stages, and every kernel for `Pipeline::device_profile`; kernels then never overlap
};

/// How a pipeline with the engine `cuda` shares a device with its caller (`Pipeline::set_device_options`). A pipeline
/// belongs to the device that is current in the thread that constructs it; `process` throws Error if another device is
/// current. `process` is synchronous: all device work of the frame has completed on return, also when it throws. After
/// an error of the device itself, such as an illegal address, CUDA accepts no more work from this process; it must be
/// restarted.
struct DeviceOptions {
  /// The stream of all work: a cudaStream_t of the caller that outlives the pipeline, or its next set_device_options.
  /// Null: a stream of the pipeline. Frames in device memory must be complete, or be written in this stream.
  CUstream_st* stream = nullptr;
  /// Copy the maps to the host. If false, the images of FrameResult are empty; the maps are available only from
  /// `Pipeline::device_maps`, and `find_damage` throws Error.
  bool download = true;
  DeviceTiming timing = DeviceTiming::none;  ///< of the frames from now on
};

/// A frame's maps in device memory, rows without padding. They remain valid and unchanged as long as a copy of `owner`
/// exists, even after later frames, which are then written to other memory, and after the pipeline is destroyed.
struct DeviceMaps {
  int width = 0;                       ///< pixels
  int height = 0;                      ///< pixels
  const std::int16_t* grey = nullptr;  ///< the left image in sixteenths of a grey level
  const float* disparity = nullptr;    ///< ℓ, pixels, NaN invalid
  const float* sigma = nullptr;        ///< standard error of the disparity, pixels, NaN invalid
  const float* transformed = nullptr;  ///< ℓ', pixels, NaN invalid
  CUstream_st* stream = nullptr;       ///< the stream that wrote them
  int device = 0;  ///< CUDA's number of the GPU; -1 with emulated kernels, whose memory is the host's
  /// May be released in any thread, also while work on the device still reads the maps.
  std::shared_ptr<const void> owner;
};

}  // namespace roadstereo
#pragma GCC visibility pop
