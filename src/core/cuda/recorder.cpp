#include "core/cuda/recorder.hpp"

#include <algorithm>

namespace roadstereo::cuda {
namespace {

int attribute(cudaDeviceAttr which) {
  int device = 0, value = 0;
  ROADSTEREO_CUDA(cudaGetDevice(&device));
  ROADSTEREO_CUDA(cudaDeviceGetAttribute(&value, which, device));
  return value;
}

int count_of(const dim3& size) {
  return static_cast<int>(size.x * size.y * size.z);
}

/// What a launch of a kernel takes of a multiprocessor.
KernelProfile describe(const char* name, const void* kernel, const LaunchShape& shape) {
  cudaFuncAttributes attributes{};
  ROADSTEREO_CUDA(cudaFuncGetAttributes(&attributes, kernel));
  KernelProfile profile;
  profile.name = name;
  profile.blocks = count_of(shape.grid);
  profile.threads = count_of(shape.block);
  profile.registers = attributes.numRegs;
  profile.local_bytes = static_cast<int>(attributes.localSizeBytes);
  profile.shared_bytes = static_cast<int>(shape.shared_bytes + attributes.sharedSizeBytes);
  int resident = 0;
  ROADSTEREO_CUDA(
      cudaOccupancyMaxActiveBlocksPerMultiprocessor(&resident, kernel, profile.threads, shape.shared_bytes));
  profile.occupancy =
      static_cast<double>(resident) * profile.threads / attribute(cudaDevAttrMaxThreadsPerMultiProcessor);
  return profile;
}

}  // namespace

void Recorder::begin() {
  counted_ = {};
  count_ = 0;
}

void Recorder::before_launch(const char* name, const void* kernel, const LaunchShape& shape, cudaStream_t stream) {
  if (count_ == launches_.size()) launches_.emplace_back();
  Launch& launch = launches_[count_];
  launch.name = name;
  launch.kernel = kernel;
  launch.shape = shape;
  launch.before.record(stream);
}

void Recorder::after_launch(cudaStream_t stream) {
  launches_[count_++].after.record(stream);
}

DeviceProfile Recorder::profile() const {
  DeviceProfile profile = counted_;
  profile.launches = static_cast<int>(count_);
  for (std::size_t i = 0; i < count_; ++i) {
    const Launch& launch = launches_[i];
    auto known = std::find_if(profile.kernels.begin(), profile.kernels.end(),
                              [&](const KernelProfile& kernel) { return kernel.name == launch.name; });
    if (known == profile.kernels.end()) {
      profile.kernels.push_back(describe(launch.name, launch.kernel, launch.shape));
      known = profile.kernels.end() - 1;
    }
    ++known->launches;
    known->ms += launch.after.ms_since(launch.before);
  }
  return profile;
}

}  // namespace roadstereo::cuda
