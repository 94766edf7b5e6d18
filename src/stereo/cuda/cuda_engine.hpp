#pragma once

#include <memory>
#include <string>

#include "roadstereo/matcher.hpp"

namespace roadstereo {

/// The engine `cuda`: matching in device memory, images and maps on the host. Throws Error, with the reason, where
/// there is no usable device.
std::unique_ptr<StereoEngine> make_cuda_engine(int threads);

}  // namespace roadstereo
