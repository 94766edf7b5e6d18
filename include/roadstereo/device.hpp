#pragma once

#include <cstdint>

struct CUstream_st;

namespace roadstereo {

/// How a pipeline with the engine `cuda` shares a device with its caller (`Pipeline::set_device_options`). A pipeline
/// belongs to the device that is current in the thread that makes it, and is used where the same one is: `process`
/// refuses any other. When it returns, the device has ended the frame. Frames in device memory need no
/// set_device_options.
struct DeviceOptions {
  /// Where all work is enqueued: a cudaStream_t of the caller, which must outlive the pipeline, or its next
  /// set_device_options. Null: a stream of the pipeline's own. Frames in device memory must be complete, or be made in
  /// this stream.
  CUstream_st* stream = nullptr;
  /// Copy the maps to the host. False leaves the images of FrameResult empty: they are in `Pipeline::device_maps`
  /// alone, and `find_damage` has nothing to look at.
  bool download = true;
};

/// The last frame's maps in device memory, rows without padding. They belong to the pipeline, and work enqueued in its
/// stream before the next frame may read them.
struct DeviceMaps {
  int width = 0;                       ///< pixels
  int height = 0;                      ///< pixels
  const std::int16_t* grey = nullptr;  ///< the left image in sixteenths of a grey level
  const float* disparity = nullptr;    ///< ℓ, pixels, NaN invalid
  const float* sigma = nullptr;        ///< standard error of the disparity, pixels, NaN invalid
  const float* transformed = nullptr;  ///< ℓ', pixels, NaN invalid
  CUstream_st* stream = nullptr;       ///< where they were made
};

}  // namespace roadstereo
