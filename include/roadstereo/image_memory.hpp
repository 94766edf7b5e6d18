#pragma once

#include <cstddef>
#include <new>
#include <type_traits>

#pragma GCC visibility push(default)
namespace roadstereo {

/// Memory of images that is not the heap's, such as pinned memory, which a device copies to at full speed. It outlives
/// every image of it.
class ImageMemory {
 public:
  /// Throws std::bad_alloc or Error when there is none.
  virtual void* allocate(std::size_t bytes) = 0;
  virtual void deallocate(void* memory) noexcept = 0;

 protected:
  ~ImageMemory() = default;
};

/// Allocator of images: allocates from an ImageMemory, or from the heap. It moves and swaps with the image.
template <class T>
class ImageAllocator {
 public:
  using value_type = T;
  using propagate_on_container_move_assignment = std::true_type;
  using propagate_on_container_swap = std::true_type;
  using is_always_equal = std::false_type;

  ImageAllocator() = default;
  explicit ImageAllocator(ImageMemory* memory) : memory_(memory) {}
  template <class U>
  ImageAllocator(const ImageAllocator<U>& other) : memory_(other.memory()) {}  // NOLINT(google-explicit-constructor)

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    return static_cast<T*>(memory_ != nullptr ? memory_->allocate(bytes) : ::operator new(bytes));
  }
  void deallocate(T* pixels, std::size_t) noexcept {
    if (memory_ != nullptr) {
      memory_->deallocate(pixels);
    } else {
      ::operator delete(pixels);
    }
  }
  /// A pixel without a value stays as it is: images of another size are written in full.
  template <class U>
  void construct(U* pixel) {
    ::new (static_cast<void*>(pixel)) U;
  }

  ImageMemory* memory() const { return memory_; }
  bool operator==(const ImageAllocator& other) const { return memory_ == other.memory_; }

 private:
  ImageMemory* memory_ = nullptr;  ///< null: the heap
};

}  // namespace roadstereo
#pragma GCC visibility pop
