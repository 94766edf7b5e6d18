#pragma once

#include <cstddef>
#include <type_traits>

#include "roadstereo/host_device.hpp"

#pragma GCC visibility push(default)
namespace roadstereo {

/// View of a rectangle of pixels that it does not own, on the host or on a device: row-major, `(u, v)` = (column, row),
/// origin top left. `stride` is the distance of two rows in elements, at least the width. C++17, for kernels.
template <class T>
class ImageView {
 public:
  ImageView() = default;
  ROADSTEREO_HD ImageView(T* data, int width, int height, std::ptrdiff_t stride)
      : data_(data), width_(width), height_(height), stride_(stride) {}
  ROADSTEREO_HD ImageView(T* data, int width, int height) : ImageView(data, width, height, width) {}
  /// A view for writing is also a view for reading.
  template <class Writable, class = std::enable_if_t<std::is_same_v<const Writable, T>>>
  ROADSTEREO_HD ImageView(const ImageView<Writable>& view)
      : ImageView(view.data(), view.width(), view.height(), view.stride()) {}

  ROADSTEREO_HD int width() const { return width_; }
  ROADSTEREO_HD int height() const { return height_; }
  ROADSTEREO_HD std::ptrdiff_t stride() const { return stride_; }
  ROADSTEREO_HD std::size_t pixels() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }
  ROADSTEREO_HD bool empty() const { return width_ == 0 || height_ == 0; }

  ROADSTEREO_HD T* data() const { return data_; }
  ROADSTEREO_HD T* row(int v) const { return data_ + v * stride_; }
  ROADSTEREO_HD T& operator()(int u, int v) const { return row(v)[u]; }

 private:
  T* data_ = nullptr;
  int width_ = 0;
  int height_ = 0;
  std::ptrdiff_t stride_ = 0;
};

}  // namespace roadstereo
#pragma GCC visibility pop
