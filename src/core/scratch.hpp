#pragma once

#include <memory_resource>
#include <vector>

#pragma GCC visibility push(default)
namespace roadstereo {

/// Keeps freed blocks for the next request of their size, rounded up to a power of two. std::pmr's pools do so for
/// blocks of at most 4 MiB only.
class ReusedBlocks : public std::pmr::memory_resource {
 public:
  ReusedBlocks() = default;
  ~ReusedBlocks() override;
  ReusedBlocks(const ReusedBlocks&) = delete;
  ReusedBlocks& operator=(const ReusedBlocks&) = delete;

 private:
  struct Block {
    void* memory = nullptr;
    std::size_t size = 0, alignment = 0;
  };
  void* do_allocate(std::size_t bytes, std::size_t alignment) override;
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override;
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }

  std::vector<Block> free_;
};

/// Memory of scratch vectors that is kept from frame to frame, so that they allocate nothing once every size has
/// occurred.
class ScratchMemory {
 public:
  std::pmr::memory_resource& resource() { return pool_; }

 private:
  ReusedBlocks blocks_;
  std::pmr::unsynchronized_pool_resource pool_{{.max_blocks_per_chunk = 1, .largest_required_pool_block = 4U << 20},
                                               &blocks_};
};

/// Sets the memory of the scratch vectors of this thread until it goes out of scope.
class ScratchScope {
 public:
  explicit ScratchScope(ScratchMemory& memory);
  ~ScratchScope();
  ScratchScope(const ScratchScope&) = delete;
  ScratchScope& operator=(const ScratchScope&) = delete;

  /// Returns the resource of this thread; the heap outside every scope.
  static std::pmr::memory_resource* memory();

 private:
  std::pmr::memory_resource* previous_;
};

/// Vector of scratch memory, which must not outlive the frame: `ScratchVector<T> v = scratch_vector<T>();`
template <class T>
using ScratchVector = std::pmr::vector<T>;

template <class T>
ScratchVector<T> scratch_vector(std::size_t size = 0, const T& value = T{}) {
  return ScratchVector<T>(size, value, ScratchScope::memory());
}

}  // namespace roadstereo
#pragma GCC visibility pop
