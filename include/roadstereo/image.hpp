#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "roadstereo/grey_scale.hpp"
#include "roadstereo/image_memory.hpp"
#include "roadstereo/image_view.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// Image that owns its pixels, without padding between rows.
template <class T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, T value = T{}) { assign(width, height, value); }
  /// An empty image whose pixels will lie in `memory`, which outlives it.
  explicit Image(ImageMemory& memory) : pixels_(ImageAllocator<T>(&memory)) {}

  /// The copy is on the heap.
  Image(const Image& other) {
    resize(other.width_, other.height_);
    std::copy(other.pixels_.begin(), other.pixels_.end(), pixels_.begin());
  }
  Image& operator=(const Image&) = default;
  /// The moved image is empty afterwards.
  Image(Image&& moved) noexcept
      : pixels_(std::move(moved.pixels_)),
        width_(std::exchange(moved.width_, 0)),
        height_(std::exchange(moved.height_, 0)) {}
  Image& operator=(Image&& moved) noexcept {
    pixels_ = std::move(moved.pixels_);
    width_ = std::exchange(moved.width_, 0);
    height_ = std::exchange(moved.height_, 0);
    return *this;
  }
  ~Image() = default;

  /// Changes the size. Does not allocate if the size is the same. Pixel values are unspecified.
  void resize(int width, int height) {
    pixels_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    width_ = width;
    height_ = height;
  }
  /// Changes the size and sets every pixel to `value`.
  void assign(int width, int height, T value) {
    resize(width, height);
    std::fill(pixels_.begin(), pixels_.end(), value);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t pixels() const { return pixels_.size(); }
  bool empty() const { return pixels_.empty(); }
  /// The memory that it was made with; null: the heap.
  const ImageMemory* memory() const { return pixels_.get_allocator().memory(); }

  T* row(int v) { return pixels_.data() + static_cast<std::ptrdiff_t>(v) * width_; }
  const T* row(int v) const { return pixels_.data() + static_cast<std::ptrdiff_t>(v) * width_; }
  T& operator()(int u, int v) { return row(v)[u]; }
  const T& operator()(int u, int v) const { return row(v)[u]; }

  ImageView<T> view() { return {pixels_.data(), width_, height_}; }
  ImageView<const T> view() const { return {pixels_.data(), width_, height_}; }
  operator ImageView<T>() { return view(); }
  operator ImageView<const T>() const { return view(); }

  bool operator==(const Image&) const = default;

 private:
  std::vector<T, ImageAllocator<T>> pixels_;
  int width_ = 0;
  int height_ = 0;
};

/// Bits of one sample of a camera frame.
enum class SampleType { u8, u16 };

/// Order of the samples of one pixel of a camera frame.
enum class ChannelOrder { grey, bgr, rgb, bgra, rgba };

/// Returns the samples per pixel: 1, 3 or 4.
int channel_count(ChannelOrder order);

/// View of a camera frame that it does not own: 8 or 16 bit, grey or colour, any stride.
struct FrameView {
  const void* data = nullptr;
  int width = 0;                    ///< pixels
  int height = 0;                   ///< pixels
  std::ptrdiff_t stride_bytes = 0;  ///< from one row to the next
  SampleType sample = SampleType::u8;
  ChannelOrder order = ChannelOrder::grey;

  // Views of samples in memory of the caller. `stride_bytes` 0: no padding between rows.
  static FrameView grey8(const std::uint8_t* data, int width, int height, std::ptrdiff_t stride_bytes = 0);
  static FrameView grey16(const std::uint16_t* data, int width, int height, std::ptrdiff_t stride_bytes = 0);
  static FrameView bgr8(const std::uint8_t* data, int width, int height, std::ptrdiff_t stride_bytes = 0);
  static FrameView bgr16(const std::uint16_t* data, int width, int height, std::ptrdiff_t stride_bytes = 0);
  static FrameView rgb8(const std::uint8_t* data, int width, int height, std::ptrdiff_t stride_bytes = 0);
  static FrameView rgb16(const std::uint16_t* data, int width, int height, std::ptrdiff_t stride_bytes = 0);
  static FrameView bgra8(const std::uint8_t* data, int width, int height, std::ptrdiff_t stride_bytes = 0);
  static FrameView bgra16(const std::uint16_t* data, int width, int height, std::ptrdiff_t stride_bytes = 0);
  static FrameView rgba8(const std::uint8_t* data, int width, int height, std::ptrdiff_t stride_bytes = 0);
  static FrameView rgba16(const std::uint16_t* data, int width, int height, std::ptrdiff_t stride_bytes = 0);
};

/// Camera frame that owns its samples, without padding between rows.
struct Frame {
  std::vector<std::uint8_t> bytes;
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  SampleType sample = SampleType::u8;
  ChannelOrder order = ChannelOrder::grey;

  FrameView view() const;
};

/// Grey image for matching: levels in sixteenths of an 8-bit level, 0 … 4080, for any bit depth of the camera. Fixed
/// point, so that sums over windows are exact and all engines get the same input.
using GreyImage = Image<std::int16_t>;

/// Converts a camera frame to grey (Rec. 601 luma for colour).
/// `white_level` is the sample value of white; 0 takes the largest value of the sample type (255 or 65535).
/// Throws Error for a null frame, a size outside 32×32 … 8192×8192, rows that overlap, 16-bit samples at odd
/// addresses, or a white level that the samples cannot have.
void to_grey(const FrameView& frame, double white_level, GreyImage& grey);

}  // namespace roadstereo
#pragma GCC visibility pop
