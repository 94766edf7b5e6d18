#include "stereo/cuda/cuda_engine.hpp"

#include "core/cuda/device.hpp"
#include "roadstereo/error.hpp"
#include "stereo/cuda/device_matcher.hpp"
#include "stereo/window.hpp"

namespace roadstereo {
namespace cuda {
namespace {

class CudaEngine final : public StereoEngine {
 public:
  explicit CudaEngine(const Device& device) : device_(device.index), matcher_(device.multiprocessors) {}

  void match(const MatchInput& input, const MatcherOptions& options, MatchMaps& maps) override {
    validate(input);
    options.validate();
    require_current_device(device_);
    const DeviceMatchMaps& found = matcher_.match(upload(input), options, stream_.get());
    const int width = input.reference.width(), height = input.reference.height();
    download(found.disparity, width, height, maps.disparity);
    download(found.variance, width, height, maps.variance);
    download(found.winner, width, height, maps.winner);
    download(found.target_winner, width, height, maps.target_winner);
    stream_.wait();
  }

 private:
  DeviceMatchInput upload(const MatchInput& input) {
    DeviceMatchInput there;
    there.reference = upload(input.reference, images_[0]);
    there.target = upload(input.target, images_[1]);
    there.disparities = input.disparities;
    if (input.first_column != nullptr) {
      const auto rows = static_cast<std::size_t>(input.reference.height());
      there.first_column = upload(input.first_column, rows, first_column_);
    }
    if (input.ranges != nullptr) {
      there.reference_ranges = upload(input.ranges->reference, ranges_[0]);
      there.target_ranges = upload(input.ranges->target, ranges_[1]);
    }
    if (input.prior != nullptr) {
      const Image<float>& prior = input.prior->disparity;
      const float* data = upload(prior.row(0), prior.pixels(), prior_);
      there.prior = {data, prior.width(), prior.height(), prior.width()};
      there.prior_factor = input.prior->factor;
    }
    return there;
  }

  template <class T>
  const T* upload(const T* from, std::size_t count, DeviceArray<T>& to) {
    to.reserve(count);
    ROADSTEREO_CUDA(cudaMemcpyAsync(to.data(), from, count * sizeof(T), cudaMemcpyHostToDevice, stream_.get()));
    return to.data();
  }

  /// SearchRanges::Range and TileRange are both two 16-bit numbers.
  const TileRange* upload(const Image<SearchRanges::Range>& ranges, DeviceArray<TileRange>& to) {
    static_assert(sizeof(SearchRanges::Range) == sizeof(TileRange));
    to.reserve(ranges.pixels());
    ROADSTEREO_CUDA(cudaMemcpyAsync(to.data(), ranges.row(0), ranges.pixels() * sizeof(TileRange),
                                    cudaMemcpyHostToDevice, stream_.get()));
    return to.data();
  }

  Plane<const std::int16_t> upload(ImageView<const std::int16_t> image, DeviceArray<std::int16_t>& to) {
    constexpr std::size_t bytes = sizeof(std::int16_t);
    to.reserve(image.pixels());
    const auto width = static_cast<std::size_t>(image.width()), stride = static_cast<std::size_t>(image.stride());
    ROADSTEREO_CUDA(cudaMemcpy2DAsync(to.data(), width * bytes, image.row(0), stride * bytes, width * bytes,
                                      static_cast<std::size_t>(image.height()), cudaMemcpyHostToDevice, stream_.get()));
    return packed_plane(to.data(), image.width(), image.height());
  }

  template <class T>
  void download(const Plane<T>& from, int width, int height, Image<T>& to) {
    to.resize(width, height);
    ROADSTEREO_CUDA(
        cudaMemcpyAsync(to.row(0), from.data, to.pixels() * sizeof(T), cudaMemcpyDeviceToHost, stream_.get()));
  }

  int device_;
  Stream stream_;
  DeviceMatcher matcher_;
  DeviceArray<std::int16_t> images_[2];
  DeviceArray<int> first_column_;
  DeviceArray<TileRange> ranges_[2];
  DeviceArray<float> prior_;
};

}  // namespace
}  // namespace cuda

std::unique_ptr<StereoEngine> make_cuda_engine(int) {
  const cuda::Device device = cuda::find_device();
  if (!device.usable) fail("the engine cuda cannot be used: ", device.reason);
  return std::make_unique<cuda::CudaEngine>(device);
}

}  // namespace roadstereo
