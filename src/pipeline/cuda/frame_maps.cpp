#include "pipeline/cuda/frame_maps.hpp"

#include <algorithm>
#include <cstring>

namespace roadstereo::cuda {
namespace {

constexpr std::size_t maps_of_floats = 3;

/// The grey levels, two to a float.
std::size_t floats_for(std::size_t pixels) {
  return maps_of_floats * pixels + (pixels + 1) / 2;
}

}  // namespace

void FrameMaps::resize(int width, int height) {
  width_ = width;
  height_ = height;
  pixels_ = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  floats_.reserve(floats_for(pixels_));
}

void FrameMaps::download(cudaStream_t stream) {
  on_host_.reserve(floats_for(pixels_));
  const std::size_t bytes = pixels_ * (maps_of_floats * sizeof(float) + sizeof(std::int16_t));
  ROADSTEREO_CUDA(cudaMemcpyAsync(on_host_.data(), floats_.data(), bytes, cudaMemcpyDeviceToHost, stream));
}

void FrameMaps::take(FrameResult& result) const {
  const float* from = on_host_.data();
  for (Image<float>* map : {&result.disparity, &result.sigma, &result.transformed}) {
    map->resize(width_, height_);
    std::copy_n(from, pixels_, map->row(0));
    from += pixels_;
  }
  result.grey.resize(width_, height_);
  std::memcpy(result.grey.row(0), from, pixels_ * sizeof(std::int16_t));
}

}  // namespace roadstereo::cuda
