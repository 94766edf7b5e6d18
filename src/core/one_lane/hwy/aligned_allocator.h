#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace hwy {

/// Bytes: a cache line, as in Highway.
inline constexpr std::align_val_t alignment{64};

/// Gives back what AllocateAligned allocated.
struct AlignedFreer {
  void operator()(void* block) const { ::operator delete(block, alignment); }
};

template <class T>
using AlignedFreeUniquePtr = std::unique_ptr<T, AlignedFreer>;

/// Room for `count` elements without values, aligned to a cache line; null when there is no memory.
template <class T>
AlignedFreeUniquePtr<T[]> AllocateAligned(std::size_t count) {
  static_assert(std::is_trivial_v<T>, "elements are neither constructed nor destroyed");
  return AlignedFreeUniquePtr<T[]>(static_cast<T*>(::operator new(count * sizeof(T), alignment, std::nothrow)));
}

}  // namespace hwy
