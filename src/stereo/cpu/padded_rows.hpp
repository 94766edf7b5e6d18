#pragma once

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <cstddef>
#include <new>

namespace roadstereo::cpu {

/// Elements that kernels may read before the first and behind the last column of a row.
inline constexpr std::ptrdiff_t row_padding = 64;

/// Rows of numbers with padding on both sides, so that kernels may read beyond their ends. What they read there is
/// finite but has no meaning. Column 0 of every row is aligned for the widest vectors.
template <class T>
class PaddedRows {
 public:
  /// `before` columns of each row lie to the left of column 0. Allocates only when there are more elements than ever.
  /// Rows that are laid out as before keep what they hold; others begin with 0.
  void resize(std::size_t rows, std::ptrdiff_t before, std::ptrdiff_t columns) {
    constexpr std::ptrdiff_t line = 128 / static_cast<std::ptrdiff_t>(sizeof(T));
    const std::ptrdiff_t offset = (row_padding + before + line - 1) / line * line;
    const std::ptrdiff_t pitch = (offset + columns + row_padding + line - 1) / line * line;
    const std::size_t size = rows * static_cast<std::size_t>(pitch);
    if (offset == offset_ && pitch == pitch_ && size == size_) return;
    if (size > capacity_) {
      size_ = capacity_ = 0;  // until there is memory
      values_ = hwy::AllocateAligned<T>(size);
      if (!values_) throw std::bad_alloc();
      capacity_ = size;
    }
    offset_ = offset;
    pitch_ = pitch;
    size_ = size;
    clear();
  }
  T* row(std::size_t r) { return values_.get() + offset_ + static_cast<std::ptrdiff_t>(r) * pitch_; }
  const T* row(std::size_t r) const { return values_.get() + offset_ + static_cast<std::ptrdiff_t>(r) * pitch_; }
  void clear() { std::fill_n(values_.get(), size_, T{}); }

 private:
  hwy::AlignedFreeUniquePtr<T[]> values_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
  std::ptrdiff_t pitch_ = 0;
  std::ptrdiff_t offset_ = 0;
};

}  // namespace roadstereo::cpu
