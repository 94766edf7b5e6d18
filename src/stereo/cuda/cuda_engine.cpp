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
  /// Memory goes only when no kernel uses it any more.
  ~CudaEngine() override { settle(); }
  CudaEngine(const CudaEngine&) = delete;
  CudaEngine& operator=(const CudaEngine&) = delete;

  void match(const MatchInput& input, const MatcherOptions& options, MatchMaps& maps) override {
    validate(input);
    options.validate();
    require_current_device(device_);
    try {
      const DeviceMatchMaps& found = matcher_.match(upload(input), options, stream());
      download(found.disparity, maps.disparity);
      download(found.variance, maps.variance);
      download(found.winner, maps.winner);
      download(found.target_winner, maps.target_winner);
    } catch (...) {
      settle();  // what copies still read or write is the caller's
      throw;
    }
    stream().wait();
  }

 private:
  StreamView stream() const { return stream_.get(); }
  void settle() const noexcept {
    stream().settle();
    matcher_.settle();
  }

  /// The input in device memory.
  MatchInput upload(const MatchInput& input) {
    MatchInput there;
    there.reference = upload(input.reference, images_[0]);
    there.target = upload(input.target, images_[1]);
    there.disparities = input.disparities;
    if (input.first_column != nullptr) {
      const int rows = input.reference.height();
      there.first_column = upload(ImageView<const int>(input.first_column, rows, 1), first_column_).data();
    }
    there.ranges = {upload(input.ranges.reference, ranges_[0]), upload(input.ranges.target, ranges_[1])};
    there.prior = {upload(input.prior.disparity, prior_[0]), input.prior.factor, upload(input.prior.low, prior_[1]),
                   upload(input.prior.high, prior_[2])};
    return there;
  }

  /// Empty images stay empty.
  template <class T>
  ImageView<const T> upload(ImageView<const T> image, DeviceArray<T>& to) {
    if (image.empty()) return {};
    to.reserve(image.pixels());
    const auto width = static_cast<std::size_t>(image.width()), stride = static_cast<std::size_t>(image.stride());
    ROADSTEREO_CUDA(cudaMemcpy2DAsync(to.data(), width * sizeof(T), image.data(), stride * sizeof(T), width * sizeof(T),
                                      static_cast<std::size_t>(image.height()), cudaMemcpyHostToDevice, stream_.get()));
    return {to.data(), image.width(), image.height()};
  }

  template <class T>
  void download(const ImageView<T>& from, Image<T>& to) {
    to.resize(from.width(), from.height());
    stream().download(to.row(0), from.data(), to.pixels() * sizeof(T));
  }

  int device_;
  Stream stream_;
  DeviceMatcher matcher_;
  DeviceArray<std::int16_t> images_[2];
  DeviceArray<int> first_column_;
  DeviceArray<SearchRange> ranges_[2];
  DeviceArray<float> prior_[3];
};

}  // namespace
}  // namespace cuda

std::unique_ptr<StereoEngine> make_cuda_engine(int) {
  const cuda::Device device = cuda::find_device();
  if (!device.usable) fail("the engine cuda cannot be used: ", device.reason);
  return std::make_unique<cuda::CudaEngine>(device);
}

}  // namespace roadstereo
